#pragma once
// Which part builds which tets, and the mesh that it assembles from them: docs/definitions.md 5.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/mesh_piece.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/hybrid/extract.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/pieces/part_view.hpp"

namespace hexpipe::assemble::pieces {

// The lists of the other pieces of the previous round.
struct RoundBefore {
  std::vector<std::int64_t> moved_tets;  // ascending
  std::vector<std::int32_t> moved_to;
  std::vector<std::int32_t> known_homes;  // parts whose moved tets are all in these lists; ascending
  std::vector<std::uint64_t> given_back;  // ascending
};

struct Pieces {
  std::vector<std::int32_t> of_tet;  // by tet of the view: the part that builds it
  // Tets at home in the view's part that another part builds, by number in the whole.
  std::vector<std::int64_t> moved_tets;
  std::vector<std::int32_t> moved_to;
};

// A cell belongs to its own part, with its interior tets and its slivers. Another tet belongs to its home: the part of
// the tet if that has a point of it, otherwise the part of its first point. But the tets around the diagonals of open
// quads that have tets in common all belong to one part, if one is near enough to all of them.
Pieces divide_tets(const PartView& view, const hybrid::SurfaceTags& tags, const TetAdjacency& adjacency,
                   const RoundBefore& before, const choice::InputNames& names);

// The remaining cells that this part builds with.
struct SeamCells {
  std::vector<CandidateIndex> own;     // of this part, ascending
  std::vector<CandidateIndex> guests;  // of others, with a quad whose tets this part builds, ascending
  // Cells of this part that go back to their tets, because a quad faces tets of several pieces; ascending.
  std::vector<CandidateIndex> given_back;
};
SeamCells cells_at_seams(const PartView& view, const hybrid::SurfaceTags& tags, const Pieces& pieces,
                         std::span<const std::uint64_t> given_back, const choice::InputNames& names);

// The tets of the part's piece, and those of the cells of others that are its guests.
struct PieceInput {
  TetMesh mesh;  // its surface is complete
  Candidates cells;
  hybrid::Seam seam;
  std::vector<CandidateIndex> view_cells;  // by candidate: its number in the view
  std::vector<std::int64_t> point_number;  // by point: its number in the whole
};

// `tags` of the view's mesh, whose surface is complete.
PieceInput cut_piece(const PartView& view, const TetAdjacency& adjacency, const hybrid::SurfaceTags& tags,
                     const Pieces& pieces, const SeamCells& cells);

}  // namespace hexpipe::assemble::pieces
