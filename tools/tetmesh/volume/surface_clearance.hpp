#pragma once
// Whether a point keeps clear of a surface, and whether it lies in material.

#include <tsl/robin_map.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "tools/tetmesh/column_index.hpp"
#include "tools/tetmesh/shells.hpp"
#include "tools/tetmesh/size_field.hpp"
#include "tools/tetmesh/volume/cell_key.hpp"

namespace hexpipe {

class SurfaceClearance {
 public:
  // The surface must outlive it.
  SurfaceClearance(const Surface& surface, const SizeField& clearance);

  // No triangle is nearer than the clearance.
  bool is_clear(const Vec3& p) const;
  bool is_inside(const Vec3& p) const { return is_in_material(surface_, columns_, p); }

 private:
  // A triangle in a cell of the grid.
  using Entry = std::pair<std::uint64_t, std::int32_t>;

  GridCell cell_of(const Vec3& p) const;
  void file(std::int32_t triangle);

  const Surface& surface_;
  SizeField clearance_;
  double width_;  // of the grid's cells
  Vec3 low_;
  ColumnIndex columns_;
  std::vector<Entry> entries_;                                     // ascending
  tsl::robin_map<std::uint64_t, std::size_t, CellKeyHash> first_;  // of the entries of each cell
};

}  // namespace hexpipe
