#include "tools/tetmesh/solid/surface_clearance.hpp"

#include <cmath>

#include "tools/tetmesh/geometry/triangle_distance.hpp"

namespace hexpipe::tetmesh::solid {

SurfaceClearance::SurfaceClearance(const Surface& surface)
    : surface_(surface),
      triangles_(geometry::tree_of_triangles(surface.points, surface.triangles)),
      columns_(surface.points, surface.triangles) {}

bool SurfaceClearance::is_clear(const Vec3& p, double clearance) const {
  const auto distance_to = [&](std::int32_t number) {
    const auto& [a, b, c] = surface_.triangles[number];
    return std::sqrt(geometry::TriangleDistance(surface_.points[a], surface_.points[b], surface_.points[c]).squared(p));
  };
  return triangles_.least(p, 1, clearance, distance_to) >= clearance;
}

}  // namespace hexpipe::tetmesh::solid
