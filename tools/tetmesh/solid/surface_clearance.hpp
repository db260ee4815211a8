#pragma once
// Whether a point keeps clear of a surface, and whether it lies in material.

#include "tools/tetmesh/geometry/column_index.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

class SurfaceClearance {
 public:
  // The surface must outlive it.
  explicit SurfaceClearance(const Surface& surface);

  // Whether no triangle is nearer than the clearance.
  bool is_clear(const Vec3& p, double clearance) const;
  bool is_inside(const Vec3& p) const { return is_in_material(surface_, columns_, p); }

 private:
  const Surface& surface_;
  geometry::BoxTree triangles_;
  geometry::ColumnIndex columns_;
};

}  // namespace hexpipe::tetmesh::solid
