#include "tools/assemble/order/given_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/mesh/facet_key.hpp"
#include "tools/assemble/shape/nearest_points.hpp"
#include "tools/assemble/shape/smooth_edges.hpp"

namespace hexpipe::assemble::order {
namespace {

constexpr double least_cosine_of_normals = 0.5;  // 60 degrees
constexpr double least_cosine_of_curves = 0.7;   // 45 degrees

Vec3 normal_of(const std::array<Vec3, 3>& t) {
  return unit(cross(t[1] - t[0], t[2] - t[0]));
}

}  // namespace

GivenSurface::GivenSurface(formats::SurfaceSoup surface)
    : surface_(std::move(surface)), triangle_tree_({}, {}), curve_tree_({}, {}) {
  find_curves(surface_);
  std::vector<Box> boxes;
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
    boxes.push_back(Box::around(corners(static_cast<std::int32_t>(t))));
  triangle_tree_ = shape::tree_of(boxes);
  boxes.clear();
  for (const Segment& segment : curves_) boxes.push_back(Box::around(segment));
  curve_tree_ = shape::tree_of(boxes);
}

std::array<Vec3, 3> GivenSurface::corners(std::int32_t triangle) const {
  const auto& [a, b, c] = surface_.triangles[static_cast<std::size_t>(triangle)];
  return {surface_.points[a], surface_.points[b], surface_.points[c]};
}

// Curves are the edges that are not smooth, and those that the CAD or the user names.
void GivenSurface::find_curves(const formats::SurfaceSoup& surface) {
  KeyMap<2, std::vector<std::int32_t>> triangles_at;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      triangles_at[edge_key(surface.triangles[t][i], surface.triangles[t][(i + 1) % 3])].push_back(
          static_cast<std::int32_t>(t));
  KeySet<2> curves;
  for (const auto& [a, b] : surface.curves) curves.insert(edge_key(a, b));
  for (const auto& [edge, at] : triangles_at) {
    const auto away_of = [&](std::int32_t t) {
      return shape::away_from_edge(surface.points, surface.triangles[static_cast<std::size_t>(t)], edge);
    };
    const bool smooth = !curves.contains(edge) && shape::is_smooth_edge(at, surface.tags, away_of);
    if (!smooth) curves_.push_back({surface.points[edge[0]], surface.points[edge[1]]});
  }
  // The order of the map is that of its buckets.
  std::ranges::sort(curves_, [](const Segment& a, const Segment& b) {
    for (int end = 0; end < 2; ++end)
      for (int axis = 0; axis < 3; ++axis)
        if (a[end][axis] != b[end][axis]) return a[end][axis] < b[end][axis];
    return false;
  });
}

std::optional<Vec3> GivenSurface::on_faces(const Vec3& to, const Vec3& normal, double most) const {
  return shape::nearest_in(triangle_tree_, to, most, [&](std::int32_t triangle) -> std::optional<Vec3> {
    const std::array<Vec3, 3> t = corners(triangle);
    if (std::abs(dot(normal_of(t), normal)) < least_cosine_of_normals) return std::nullopt;
    return shape::nearest_on_triangle(t, to);
  });
}

std::optional<Vec3> GivenSurface::on_curves(const Vec3& to, const Vec3& direction, double most) const {
  return shape::nearest_in(curve_tree_, to, most, [&](std::int32_t curve) -> std::optional<Vec3> {
    const Segment& segment = curves_[static_cast<std::size_t>(curve)];
    if (std::abs(dot(unit(segment[1] - segment[0]), direction)) < least_cosine_of_curves) return std::nullopt;
    return shape::nearest_on_segment(segment[0], segment[1], to);
  });
}

}  // namespace hexpipe::assemble::order
