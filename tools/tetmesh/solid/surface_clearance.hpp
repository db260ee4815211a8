#pragma once
// Whether a point keeps clear of a surface, and whether it lies in material.

#include <cmath>

#include "tools/tetmesh/geometry/column_index.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

class SurfaceClearance {
 public:
  // The surface must outlive it.
  explicit SurfaceClearance(const Surface& surface)
      : surface_(surface),
        triangles_(geometry::tree_of_triangles(surface.points, surface.triangles)),
        columns_(surface.points, surface.triangles) {}

  // Whether no triangle is nearer than the clearance.
  bool is_clear(const Vec3& p, double clearance) const {
    const auto distance_to = [&](std::int32_t number) {
      const auto& [a, b, c] = surface_.triangles[number];
      const geometry::TriangleDistance distance(surface_.points[a], surface_.points[b], surface_.points[c]);
      return std::sqrt(distance.squared(p));
    };
    return triangles_.least(p, 1, clearance, distance_to) >= clearance;
  }
  bool is_inside(const Vec3& p) const { return is_in_material(surface_, columns_, p); }

 private:
  const Surface& surface_;
  geometry::BoxTree triangles_;
  geometry::ColumnIndex columns_;
};

}  // namespace hexpipe::tetmesh::solid
