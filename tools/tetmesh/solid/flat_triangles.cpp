#include "tools/tetmesh/solid/flat_triangles.hpp"

#include <algorithm>
#include <cmath>

#include "common/mesh/facet_key.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/solid/borders.hpp"

namespace hexpipe::tetmesh::solid {
namespace {

using geometry::HalfEdge;

// The greatest height of a flat triangle, as a share of the diagonal, though rounding may be more far from the origin.
constexpr double flattest_of_diagonal = 1e-6;
// The middle corner of a flat triangle is this many times that away from the others, or two corners are nearly one.
constexpr double least_foot = 10;
// The least cosine of the angle by which the triangle beyond turns.
constexpr double least_turn_cosine = 0.9;

class FlatTriangleFlipper {
 public:
  explicit FlatTriangleFlipper(Surface& surface)
      : surface_(surface),
        tolerance_(
            std::min(rounding_of(surface), flattest_of_diagonal * geometry::Box::around(surface.points).diagonal())) {}

  std::size_t run() {
    std::vector<std::int32_t> waiting;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(surface_.triangles.size()); ++t)
      if (long_edge_of(t) != no_index) waiting.push_back(t);
    if (waiting.empty()) return 0;
    find_neighbours();
    std::size_t flips = 0;
    while (!waiting.empty()) {
      const std::int32_t t = waiting.back();
      waiting.pop_back();
      const HalfEdge h = long_edge_of(t);
      if (h == no_index || !can_flip(h)) continue;
      const std::int32_t beyond = geometry::triangle_of(twins_[h]);
      flip(h);
      ++flips;
      // Flat triangles beside it may have waited for this.
      for (const std::int32_t changed : {t, beyond})
        for (HalfEdge side = 3 * changed; side < 3 * changed + 3; ++side)
          if (twins_[side] != no_index) waiting.push_back(geometry::triangle_of(twins_[side]));
    }
    return flips;
  }

 private:
  const Vec3& point(Vertex v) const { return surface_.points[v]; }
  Vertex corner_across(HalfEdge h) const { return geometry::corner_across(surface_.triangles, h); }

  // Of a flat triangle; otherwise no_index.
  HalfEdge long_edge_of(std::int32_t t) const {
    HalfEdge longest = no_index;
    double length = 0;
    for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
      const double of_side =
          norm(point(geometry::end_of(surface_.triangles, h)) - point(geometry::start_of(surface_.triangles, h)));
      if (of_side > length) {
        length = of_side;
        longest = h;
      }
    }
    if (longest == no_index) return no_index;
    const Vec3 &a = point(geometry::start_of(surface_.triangles, longest)),
               &b = point(geometry::end_of(surface_.triangles, longest)), &corner = point(corner_across(longest));
    const double height = norm(cross(b - a, corner - a)) / length, foot = dot(corner - a, b - a) / length;
    const bool is_flat = height <= tolerance_ && std::min(foot, length - foot) > least_foot * tolerance_;
    return is_flat ? longest : no_index;
  }

  void find_neighbours() {
    twins_.assign(3 * surface_.triangles.size(), no_index);
    geometry::for_each_edge(surface_.points.size(), surface_.triangles, [&](std::span<const HalfEdge> edge) {
      edges_.insert(key_of(edge[0]));
      if (edge.size() != 2) return;
      twins_[edge[0]] = edge[1];
      twins_[edge[1]] = edge[0];
    });
    for (const formats::CurveEdge& edge : surface_.curves) curves_.insert(edge_key(edge[0], edge[1]));
  }

  VertexKey<2> key_of(HalfEdge h) const {
    return edge_key(geometry::start_of(surface_.triangles, h), geometry::end_of(surface_.triangles, h));
  }

  bool can_flip(HalfEdge h) const {
    const HalfEdge twin = twins_[h];
    if (twin == no_index || curves_.contains(key_of(h))) return false;
    const std::int32_t t = geometry::triangle_of(h), beyond = geometry::triangle_of(twin);
    if (surface_.tags[t] != surface_.tags[beyond] || surface_.shell_of[t] != surface_.shell_of[beyond]) return false;
    if (!surface_.sides.empty() && surface_.sides[t] != surface_.sides[beyond]) return false;
    const Vertex middle = corner_across(h), across = corner_across(twin);
    if (geometry::start_of(surface_.triangles, h) != geometry::end_of(surface_.triangles, twin) ||
        edges_.contains(edge_key(middle, across)))
      return false;
    const Vec3 &a = point(geometry::start_of(surface_.triangles, h)),
               &b = point(geometry::end_of(surface_.triangles, h));
    const Vec3 before = cross(a - b, point(across) - b);
    // Neither of the two is flat, so there are fewer such triangles afterwards.
    const auto is_fine = [&](const Vec3& from, const Vec3& to) {
      const Vec3 after = cross(to - from, point(middle) - from);
      const double longest = std::max({norm(to - from), norm(point(middle) - from), norm(point(middle) - to)});
      return norm(after) > tolerance_ * longest && dot(before, after) > least_turn_cosine * norm(before) * norm(after);
    };
    return is_fine(a, point(across)) && is_fine(point(across), b);
  }

  void flip(HalfEdge h) {
    const HalfEdge twin = twins_[h];
    const std::int32_t t = geometry::triangle_of(h), beyond = geometry::triangle_of(twin);
    const Vertex a = geometry::start_of(surface_.triangles, h), b = geometry::end_of(surface_.triangles, h),
                 middle = corner_across(h), across = corner_across(twin);
    const HalfEdge of_b = twins_[geometry::next_in_triangle(h)], of_a = twins_[geometry::previous_in_triangle(h)],
                   beyond_a = twins_[geometry::next_in_triangle(twin)],
                   beyond_b = twins_[geometry::previous_in_triangle(twin)];
    edges_.erase(edge_key(a, b));
    edges_.insert(edge_key(middle, across));
    surface_.triangles[t] = {middle, a, across};
    surface_.triangles[beyond] = {middle, across, b};
    pair(3 * t, of_a), pair(3 * t + 1, beyond_a), pair(3 * t + 2, 3 * beyond);
    pair(3 * beyond + 1, beyond_b), pair(3 * beyond + 2, of_b);
  }

  void pair(HalfEdge h, HalfEdge twin) {
    twins_[h] = twin;
    if (twin != no_index) twins_[twin] = h;
  }

  Surface& surface_;
  double tolerance_;
  std::vector<HalfEdge> twins_;  // of edges with two triangles; otherwise no_index
  KeySet<2> edges_, curves_;
};

}  // namespace

std::size_t flip_flat_triangles(Surface& surface) {
  return FlatTriangleFlipper(surface).run();
}

}  // namespace hexpipe::tetmesh::solid
