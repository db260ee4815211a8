#pragma once
// Whether a point keeps clear of a surface, and whether it lies in material.

#include "tools/tetmesh/box_tree.hpp"
#include "tools/tetmesh/column_index.hpp"
#include "tools/tetmesh/shells.hpp"
#include "tools/tetmesh/size_field.hpp"

namespace hexpipe {

class SurfaceClearance {
 public:
  // The surface must outlive it.
  SurfaceClearance(const Surface& surface, const SizeField& clearance);

  // No triangle is nearer than the clearance there.
  bool is_clear(const Vec3& p) const;
  bool is_inside(const Vec3& p) const { return is_in_material(surface_, columns_, p); }

 private:
  const Surface& surface_;
  SizeField clearance_;
  BoxTree triangles_;
  ColumnIndex columns_;
};

}  // namespace hexpipe
