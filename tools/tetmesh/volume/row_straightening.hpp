#pragma once
// Lines along which rows end, made straight: a line that moves over by a cell from one layer to the next costs about
// ten cells that are no hexes there, and a straight one a prism a layer.

#include <array>
#include <span>
#include <vector>

#include "common/mesh/vec3.hpp"

namespace hexpipe::tetmesh::volume {

// A point of a lattice inside, and the steps from it to the next points along the lattice's axes.
struct RowPoint {
  Vec3 at;
  std::array<Vec3, 3> steps;
};

// Merges pairs of points of neighbouring rows that come near each other where one of the two rows is about to end: in
// the next place along the row, and in the next layer, there is only one point in the place of the two. `fixed` are
// points around that stay. Returns the points that are left, in the same order.
std::vector<RowPoint> straighten_row_ends(std::span<const Vec3> fixed, std::vector<RowPoint> points);

}  // namespace hexpipe::tetmesh::volume
