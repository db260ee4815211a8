#include "tools/tessellate/crossings.hpp"

#include <algorithm>
#include <utility>

#include "common/mesh/apart_test.hpp"
#include "common/mesh/box_tree.hpp"
#include "common/mesh/validity.hpp"

namespace hexpipe::tessellate {
namespace {

// Pairs are counted up to this number: copies of bodies have one for each two triangles.
constexpr std::size_t most_pairs = 10'000;

// Another point on the line through p along an axis.
Vec3 beside(Vec3 p, int axis) {
  double& coordinate = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
  coordinate = coordinate > 0 ? -1 : 1;
  return p;
}

// A triangle with an area, and a point beside its plane. Seen from there, signs of tets are signs of triangles in the
// plane.
class PlaneTriangle {
 public:
  PlaneTriangle(const Vec3& a, const Vec3& b, const Vec3& c) : corners_{a, b, c} {
    for (int axis = 0; axis < 3 && turn_ == 0; ++axis) {
      apex_ = beside(a, axis);
      turn_ = orientation(a, b, c, apex_);
    }
  }

  bool has_area() const { return turn_ != 0; }
  const Vec3& corner(int k) const { return corners_[k % 3]; }

  // Whether the segment from p to q has a point in common with the triangle, borders included.
  bool meets(const Vec3& p, const Vec3& q) const {
    const auto& [a, b, c] = corners_;
    const int side_of_p = orientation(a, b, c, p), side_of_q = orientation(a, b, c, q);
    if (side_of_p * side_of_q > 0) return false;
    if (side_of_p == 0 && side_of_q == 0) return meets_in_plane(p, q);
    const std::array turns{orientation(p, q, a, b), orientation(p, q, b, c), orientation(p, q, c, a)};
    const auto [least, greatest] = std::ranges::minmax(turns);
    return least >= 0 || greatest <= 0;
  }

  // Whether p, in the triangle's plane, is on the triangle's side of the edge from corner k to the next.
  int side_of_edge(int k, const Vec3& p) const { return turn_ * orientation(corner(k), corner(k + 1), p, apex_); }
  bool has_in_plane(const Vec3& p) const { return orientation(corners_[0], corners_[1], corners_[2], p) == 0; }

 private:
  // Two convex figures in a plane are apart where a line along an edge of one of them has the other beyond it.
  bool meets_in_plane(const Vec3& p, const Vec3& q) const {
    for (int k = 0; k < 3; ++k)
      if (side_of_edge(k, p) < 0 && side_of_edge(k, q) < 0) return false;
    const auto& [a, b, c] = corners_;
    const std::array sides{orientation(p, q, a, apex_), orientation(p, q, b, apex_), orientation(p, q, c, apex_)};
    const auto [least, greatest] = std::ranges::minmax(sides);
    return least <= 0 && greatest >= 0;
  }

  std::array<Vec3, 3> corners_;
  Vec3 apex_{};
  int turn_ = 0;
};

// The corners of a triangle, those that it shares with another one first, turned so that the order stays cyclic.
struct CornersBeside {
  int shared = 0;
  Triangle corners{};

  CornersBeside(const Triangle& of, const Triangle& other) {
    const auto is_shared = [&](Vertex v) { return std::ranges::find(other, v) != other.end(); };
    shared = static_cast<int>(std::ranges::count_if(of, is_shared));
    int first = 0;
    while (shared > 0 && shared < 3 && !(is_shared(of[first]) && !is_shared(of[(first + 2) % 3]))) ++first;
    for (int k = 0; k < 3; ++k) corners[k] = of[(first + k) % 3];
  }
};

class CrossingTest {
 public:
  CrossingTest(std::span<const Vec3> points, std::span<const Triangle> triangles)
      : points_(points), triangles_(triangles), apart_(points, triangles) {}

  bool operator()(std::int32_t one, std::int32_t other) const {
    const CornersBeside a(triangles_[one], triangles_[other]), b(triangles_[other], triangles_[one]);
    switch (a.shared) {
      case 0:
        return !apart_.are_apart(one, other) && meet(triangle(a.corners), triangle(b.corners));
      case 1:
        return !apart_.are_apart_beyond_corner(a.corners, b.corners) &&
               meet_beyond_corner(triangle(a.corners), triangle(b.corners));
      case 2:
        return overlap_at_edge(triangle(a.corners), points_[b.corners[2]]);
      default:
        return false;
    }
  }

  PlaneTriangle triangle(const Triangle& t) const { return {points_[t[0]], points_[t[1]], points_[t[2]]}; }

 private:
  static bool meet(const PlaneTriangle& a, const PlaneTriangle& b) {
    for (int k = 0; k < 3; ++k)
      if (a.meets(b.corner(k), b.corner(k + 1)) || b.meets(a.corner(k), a.corner(k + 1))) return true;
    return false;
  }

  // If triangles with a common corner 0 also meet elsewhere, the side opposite that corner of one meets the other.
  static bool meet_beyond_corner(const PlaneTriangle& a, const PlaneTriangle& b) {
    return a.meets(b.corner(1), b.corner(2)) || b.meets(a.corner(1), a.corner(2));
  }

  // Triangles with a common edge 01 overlap only in one plane, on the same side of the edge.
  static bool overlap_at_edge(const PlaneTriangle& a, const Vec3& opposite) {
    return a.has_in_plane(opposite) && a.side_of_edge(0, opposite) > 0;
  }

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  ApartTest apart_;
};

}  // namespace

std::vector<std::array<std::int32_t, 2>> crossing_triangles(std::span<const Vec3> points,
                                                            std::span<const Triangle> triangles) {
  const CrossingTest cross(points, triangles);
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  std::vector<bool> is_flat(triangles.size()), is_at_flat(points.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    boxes.push_back(Box::around(std::array{points[t[0]], points[t[1]], points[t[2]]}));
    is_flat[i] = !cross.triangle(t).has_area();
    for (const Vertex v : t) is_at_flat[v] = is_at_flat[v] || is_flat[i];
  }
  const auto is_beside_flat = [&](std::int32_t i) {
    return std::ranges::any_of(triangles[i], [&](Vertex v) { return is_at_flat[v]; });
  };
  std::vector<std::array<std::int32_t, 2>> pairs;
  const BoxTree tree(boxes, std::vector<double>(boxes.size()));
  for (std::int32_t one = 0; one < static_cast<std::int32_t>(triangles.size()) && pairs.size() < most_pairs; ++one) {
    if (is_flat[one]) continue;
    tree.for_each_near(boxes[one], [&](std::int32_t other) {
      if (other <= one || is_flat[other] || !boxes[one].meets(boxes[other])) return;
      if (is_beside_flat(one) && is_beside_flat(other)) return;
      if (cross(one, other)) pairs.push_back({one, other});
    });
  }
  std::ranges::sort(pairs);
  if (pairs.size() > most_pairs) pairs.resize(most_pairs);
  return pairs;
}

}  // namespace hexpipe::tessellate
