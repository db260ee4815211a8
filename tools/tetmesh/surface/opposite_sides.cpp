#include "tools/tetmesh/surface/opposite_sides.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

constexpr double furthest_side = 25;  // in sizes
constexpr double parallel_cosine = 0.9;
// In sizes. Anything nearer than that to a triangle is not on another side.
constexpr double nearest_side = 1e-6;
// The area that a ray stands for, in squares of the size.
constexpr double least_area = 0.25;

OppositeSide look_across(const FieldSurface& surface, const geometry::BoxTree& tree, const AreaSample& sample,
                         const Vec3& inwards) {
  const Vec3& from = surface.centres[sample.triangle];
  const double here = surface.sizes[sample.triangle];
  OppositeSide side;
  side.from = sample.triangle;
  side.area = sample.squares;
  double best = furthest_side * here;
  tree.first_hit(from, inwards, best, [&](std::int32_t triangle) {
    const auto& [a, b, c] = surface.triangles[triangle];
    const double length =
        geometry::length_to_triangle(from, inwards, surface.points[a], surface.points[b], surface.points[c]);
    if (length <= nearest_side * here || length >= best) return std::numeric_limits<double>::infinity();
    best = length;
    side.triangle = triangle;
    side.distance = length / here;
    return length;
  });
  if (side.triangle == no_index) return side;
  const double cosine = dot(surface.normals[side.triangle], inwards);
  if (!((surface.is_interface[side.triangle] ? std::abs(cosine) : cosine) > parallel_cosine)) side.triangle = no_index;
  return side;
}

}  // namespace

std::vector<OppositeSide> opposite_sides(const FieldSurface& surface) {
  const geometry::BoxTree tree = geometry::tree_of_triangles(surface.points, surface.triangles);
  const std::vector<AreaSample> samples = surface.samples(least_area);
  std::vector<std::array<OppositeSide, 2>> found(samples.size());  // behind each triangle, and in front of it
  parallel_for(static_cast<std::int64_t>(samples.size()), 64, [&](std::int64_t i) {
    const Vec3& normal = surface.normals[samples[i].triangle];
    found[i][0] = look_across(surface, tree, samples[i], -normal);
    if (surface.is_interface[samples[i].triangle]) found[i][1] = look_across(surface, tree, samples[i], normal);
  });
  std::vector<OppositeSide> result;
  for (const auto& both : found)
    std::ranges::copy_if(both, std::back_inserter(result),
                         [](const OppositeSide& side) { return side.triangle != no_index; });
  return result;
}

}  // namespace hexpipe::tetmesh::surface
