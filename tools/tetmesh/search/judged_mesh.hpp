#pragma once
// A mesh with the hexes that it is estimated to give, and their worth.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/search/hex_choice.hpp"
#include "tools/tetmesh/tetgen/build_mesh.hpp"

namespace hexpipe::tetmesh::search {

struct JudgedMesh {
  tetgen::BuiltMesh built;
  std::vector<ChosenHex> hexes;          // chosen
  std::vector<std::int32_t> hex_of_tet;  // or no_index
  std::vector<TetIndex> left;            // tets of no hex

  // By hex: its middle, and its worth. The worth is the volume, less the cost of closing the quads that have no hex and
  // no boundary on the other side: assemble puts pyramids there, and moves vertices until these are no slivers.
  std::vector<Vec3> middles;
  std::vector<double> worth;

  double hex_volume() const;
  double total_worth() const;
};

// The hexes must fit together.
JudgedMesh judge(tetgen::BuiltMesh built, std::vector<ChosenHex> hexes);

}  // namespace hexpipe::tetmesh::search
