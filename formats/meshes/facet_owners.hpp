#pragma once
// Finds the cell that each boundary or interface facet of a mixed mesh belongs to. Formats that name surfaces by cell
// and facet number need it, and pictures give a facet the region and the quality of its cell.

#include <cstdint>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::formats {

struct FacetOwner {
  std::int64_t cell = no_index;  // within the block of its kind; no_index: the facet belongs to no cell
  CellKind kind = CellKind::tet;
  std::uint8_t facet = 0;  // in the topology's list of triangles or of quads
  std::int32_t cells = 0;  // how many have the facet: 1 on the boundary, 2 inside
};

struct FacetOwners {
  std::vector<FacetOwner> triangles, quads;  // one for each of the mesh
};

// The owner of a facet is the first cell that it points out of; if there is no such cell, the first one that has it.
FacetOwners find_facet_owners(const MixedMesh& mesh);

}  // namespace hexpipe::formats
