// Apart from the others because it includes CGAL, which takes long to compile; box_intersection_d is under the GPL.

#include "tools/tetmesh/geometry/exact_geometry.hpp"

#include <CGAL/Bbox_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "common/mesh/apart_test.hpp"
#include "common/mesh/box_tree.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::tetmesh::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
constexpr std::size_t triangles_in_branch = 512;

using TriangleBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::int32_t>;

Point to_cgal(const Vec3& p) {
  return {p.x, p.y, p.z};
}

// The corners that two triangles share: shared vertices come first, then the others, in cyclic order.
struct SharedCorners {
  int count = 0;
  std::array<Vertex, 3> first, second;
};

SharedCorners shared_corners(const Triangle& first, const Triangle& second) {
  SharedCorners shared{0, first, second};
  for (const Vertex v : first) {
    const auto found = std::find(shared.second.begin() + shared.count, shared.second.end(), v);
    if (found == shared.second.end()) continue;
    std::iter_swap(found, shared.second.begin() + shared.count);
    std::iter_swap(std::find(shared.first.begin(), shared.first.end(), v), shared.first.begin() + shared.count);
    ++shared.count;
  }
  return shared;
}

class IntersectionTest {
 public:
  IntersectionTest(std::span<const Vec3> points, std::span<const Triangle> triangles)
      : points_(points), triangles_(triangles), apart_(points, triangles) {}

  bool operator()(std::int32_t first, std::int32_t second) const {
    const SharedCorners corners = shared_corners(triangles_[first], triangles_[second]);
    switch (corners.count) {
      case 0:
        if (apart_.are_apart(first, second)) return false;
        return CGAL::do_intersect(triangle(corners.first), triangle(corners.second));
      case 1:
        if (apart_.are_apart_beyond_corner(corners.first, corners.second)) return false;
        return meet_beyond_vertex(corners.first, corners.second);
      case 2:
        return fold_onto_each_other(corners.first, corners.second);
      default:
        return true;
    }
  }

 private:
  Point point(Vertex v) const { return to_cgal(points_[v]); }
  Kernel::Triangle_3 triangle(const std::array<Vertex, 3>& t) const { return {point(t[0]), point(t[1]), point(t[2])}; }

  // If two triangles with a common corner 0 also meet elsewhere, the side opposite that corner of one of them meets the
  // other triangle.
  bool meet_beyond_vertex(const std::array<Vertex, 3>& a, const std::array<Vertex, 3>& b) const {
    const Kernel::Segment_3 side_of_a(point(a[1]), point(a[2])), side_of_b(point(b[1]), point(b[2]));
    return CGAL::do_intersect(triangle(a), side_of_b) || CGAL::do_intersect(triangle(b), side_of_a);
  }

  // Two triangles with a common edge 01 overlap only if they lie in one plane on the same side of the edge.
  bool fold_onto_each_other(const std::array<Vertex, 3>& a, const std::array<Vertex, 3>& b) const {
    const Point p = point(a[0]), q = point(a[1]), r = point(a[2]), s = point(b[2]);
    return CGAL::orientation(p, q, r, s) == CGAL::COPLANAR && CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
  }

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  ApartTest apart_;
};

std::vector<TriangleBox> boxes_of(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  std::vector<TriangleBox> boxes;
  boxes.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    CGAL::Bbox_3 bounds;
    for (const Vertex v : t) bounds += to_cgal(points[v]).bbox();
    boxes.emplace_back(bounds, static_cast<std::int32_t>(boxes.size()));
  }
  return boxes;
}

struct LimitReached {};

// All pairs of triangles that intersect; nothing if there are more than the limit.
std::optional<std::vector<std::array<std::int32_t, 2>>> all_intersections(std::span<const Vec3> points,
                                                                          std::span<const Triangle> triangles,
                                                                          const IntersectionTest& intersect,
                                                                          std::size_t limit) {
  using Pairs = std::vector<std::array<std::int32_t, 2>>;
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) boxes.push_back(Box::around(std::array{points[a], points[b], points[c]}));
  const BoxTree tree(boxes, std::vector<double>(boxes.size()));
  const std::vector<BoxTree::Meeting> meetings = tree.meetings(triangles_in_branch);
  Pairs all;
  try {
    parallel_in_order(
        static_cast<std::int64_t>(meetings.size()), 1,
        [&](std::int64_t begin, std::int64_t) {
          Pairs pairs;
          tree.for_each_near_pair(meetings[begin], [&](std::int32_t one, std::int32_t other) {
            if (pairs.size() <= limit && boxes[one].meets(boxes[other]) && intersect(one, other))
              pairs.push_back({std::min(one, other), std::max(one, other)});
          });
          return pairs;
        },
        [&](const Pairs& pairs) {
          all.insert(all.end(), pairs.begin(), pairs.end());
          if (all.size() > limit) throw LimitReached();
        });
  } catch (const LimitReached&) {
    return std::nullopt;
  }
  return all;
}

}  // namespace

int orientation_along_z(const Vec3& a, const Vec3& b, const Vec3& c) {
  return CGAL::orientation(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y), Kernel::Point_2(c.x, c.y));
}

bool are_collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  return CGAL::collinear(to_cgal(a), to_cgal(b), to_cgal(c));
}

IntersectionReport find_intersections(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                      std::size_t limit) {
  IntersectionReport report;
  const IntersectionTest intersect(points, triangles);
  if (auto all = all_intersections(points, triangles, intersect, limit)) {
    report.pairs = std::move(*all);
    std::ranges::sort(report.pairs);
    return report;
  }
  // CGAL's search decides which pairs are reported where there are too many. It takes longer.
  auto take = [&](const TriangleBox& first, const TriangleBox& second) {
    if (!intersect(first.info(), second.info())) return;
    if (report.pairs.size() == limit) throw LimitReached();
    report.pairs.push_back({std::min(first.info(), second.info()), std::max(first.info(), second.info())});
  };
  // Boxes of the slices of narrow triangles are no help here: on a leaning cylinder of 4,000 triangles, three times as
  // many pairs of slices meet as pairs of whole triangles.
  std::vector<TriangleBox> boxes = boxes_of(points, triangles);
  try {
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), take);
  } catch (const LimitReached&) {
    report.complete = false;
  }
  std::ranges::sort(report.pairs);
  return report;
}

}  // namespace hexpipe::tetmesh::geometry
