#pragma once
// From the mesh under assembly to the result: cells in a stable order, tagged facets, vertices without gaps; and what
// of it belongs to a piece of a mesh (docs/definitions.md 5).

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::hybrid {

// Only the first `Corners` count.
template <int Corners>
void append(CellBlock<Corners>& block, std::span<const Vertex> corners, std::int32_t tag) {
  std::copy_n(corners.begin(), Corners, block.cells.emplace_back().begin());
  block.tags.push_back(tag);
}
void append_cell(MixedMesh& mesh, CellKind kind, std::span<const Vertex> corners, std::int32_t tag);

struct Extract {
  MixedMesh mesh;
  // By point: its vertex in the mesh under assembly. Numbers below the input's number of points are the input's.
  std::vector<Vertex> origin;
};

// Cells come in the order of their candidates, then tets and pyramids in the order in which they were made. Each tagged
// triangle of `tags` is there as it is, or as a quad together with another one, in their order and orientation.
// Vertices keep their order; those that no cell uses are dropped.
Extract extract(const HybridMesh& mesh, const SurfaceTags& tags);

// Where a piece ends and those of other parts begin.
struct Seam {
  // By vertex of the input: 1 where other pieces have cells too, so that it stays where it is.
  std::vector<std::uint8_t> is_shared;
  // By candidate: 1 for a guest, a cell of another part. It is there so that a quad of it that faces tets of this piece
  // gets its pyramid, or the guest goes back to its tets.
  std::vector<std::uint8_t> is_guest;
  // The region of the guests' tets, and the tag of facets that only guests have.
  std::int32_t guest_region = 0, guest_tag = 0;
  // The tag of facets where the piece ends inside the mesh, and of tagged ones that another piece writes.
  std::int32_t seam_tag = 0;
};

// Leaves out the guests' cells and facets, and vertices that no other cell uses.
Extract without_guests(const Extract& from, const Seam& seam);
// Leaves out facets that have the seam's tag.
Extract without_seam_facets(Extract from, const Seam& seam);

}  // namespace hexpipe::assemble::hybrid
