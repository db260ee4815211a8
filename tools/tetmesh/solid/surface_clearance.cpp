#include "tools/tetmesh/solid/surface_clearance.hpp"

#include <cmath>

#include "tools/tetmesh/geometry/triangle_distance.hpp"

namespace hexpipe::tetmesh::solid {

SurfaceClearance::SurfaceClearance(const Surface& surface)
    : surface_(surface),
      triangles_(geometry::tree_of_triangles(surface.points, surface.triangles)),
      columns_(surface.points, surface.triangles) {}

bool SurfaceClearance::is_clear(const Vec3& p, double clearance) const {
  // One triangle that is too near ends the search: nothing is nearer than 0.
  const auto distance_to = [&](std::int32_t number) {
    const auto& [a, b, c] = surface_.triangles[number];
    const double distance =
        std::sqrt(geometry::TriangleDistance(surface_.points[a], surface_.points[b], surface_.points[c]).squared(p));
    return distance < clearance ? 0 : distance;
  };
  return triangles_.least(p, 1, clearance, distance_to) >= clearance;
}

}  // namespace hexpipe::tetmesh::solid
