#include "tools/tetmesh/surface/opposite_sides.hpp"

#include <array>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/geometry/box_tree.hpp"
#include "tools/tetmesh/geometry/ray_hit.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

constexpr double furthest = 25;  // in sizes
constexpr double least_cosine = 0.9;
// In sizes. Anything nearer than that to a triangle is not on another side.
constexpr double least_distance = 1e-6;
// The area that a ray stands for, in squares of the size.
constexpr double least_area = 0.25;

}  // namespace

std::vector<OppositeSide> opposite_sides(const FieldSurface& surface) {
  const geometry::BoxTree tree = geometry::tree_of_triangles(surface.points, surface.triangles);
  std::vector<OppositeSide> result(surface.triangles.size());
  const std::vector<AreaSample> samples = surface.samples(least_area);
  parallel_for(static_cast<std::int64_t>(samples.size()), 64, [&](std::int64_t i) {
    const std::int32_t f = samples[i].triangle;
    const Vec3 &from = surface.centres[f], inwards = -surface.normals[f];
    const double here = surface.sizes[f];
    OppositeSide& side = result[f];
    side.area = samples[i].squares;
    double best = furthest * here;
    tree.first_hit(from, inwards, best, [&](std::int32_t triangle) {
      const auto& [a, b, c] = surface.triangles[triangle];
      const double length =
          geometry::length_to_triangle(from, inwards, surface.points[a], surface.points[b], surface.points[c]);
      if (length <= least_distance * here || length >= best) return std::numeric_limits<double>::infinity();
      best = length;
      side.triangle = triangle;
      side.distance = length / here;
      return length;
    });
    if (side.triangle >= 0 && !(dot(surface.normals[side.triangle], inwards) > least_cosine)) side.triangle = -1;
  });
  return result;
}

}  // namespace hexpipe::tetmesh::surface
