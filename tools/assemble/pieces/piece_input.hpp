#pragma once
// The mesh that one part assembles: the tets of its piece, and those of the cells of others that are its guests.

#include <cstdint>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "tools/assemble/hybrid/seam.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/pieces/part_view.hpp"
#include "tools/assemble/pieces/pieces.hpp"

namespace hexpipe::assemble::pieces {

struct PieceInput {
  TetMesh mesh;  // with every facet of its boundary and interfaces among its triangles
  Candidates cells;
  hybrid::Seam seam;
  std::vector<std::int32_t> view_cells;    // by candidate, its number in the view
  std::vector<std::int64_t> point_number;  // in the whole
};

// `tags` of the view's mesh, whose surface is complete.
PieceInput cut_piece(const PartView& view, const TetAdjacency& adjacency, const hybrid::SurfaceTags& tags,
                     const Pieces& pieces, const SeamCells& cells);

}  // namespace hexpipe::assemble::pieces
