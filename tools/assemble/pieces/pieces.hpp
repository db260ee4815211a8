#pragma once
// Which part builds which tets: docs/definitions.md 5.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/mesh_piece.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/pieces/part_view.hpp"

namespace hexpipe::assemble::pieces {

// What the other pieces of the round before say.
struct RoundBefore {
  std::vector<std::int64_t> moved_tets;  // ascending
  std::vector<std::int32_t> moved_to;
  std::vector<std::int32_t> known_homes;  // parts whose tets have moved if they are named above, else not; ascending
  std::vector<std::uint64_t> given_back;  // ascending
};

struct Pieces {
  std::vector<std::int32_t> of_tet;  // by tet of the view
  // Those at home in the view's part that another part builds, by number in the whole.
  std::vector<std::int64_t> moved_tets;
  std::vector<std::int32_t> moved_to;
};

// A cell with its interior tets and its slivers belongs to its own part. Other tets belong to their home, the part of
// the tet if a point of it is of that part, else that of its first point; but those around the diagonals of open quads
// that have tets in common belong all to one part, where one is near enough to all of them.
Pieces divide_tets(const PartView& view, const hybrid::SurfaceTags& tags, const TetAdjacency& adjacency,
                   const RoundBefore& before, const choice::InputNames& names);

// How the cells that are left stand at the seams.
struct SeamCells {
  std::vector<std::int32_t> own;     // of this part, ascending
  std::vector<std::int32_t> guests;  // of others, with a quad whose tets this part builds, ascending
  // Of this part, with a quad that faces tets of several pieces, or was given back by one.
  std::vector<std::int32_t> given_back;
};
SeamCells cells_at_seams(const PartView& view, const hybrid::SurfaceTags& tags, const Pieces& pieces,
                         std::span<const std::uint64_t> given_back, const choice::InputNames& names);

}  // namespace hexpipe::assemble::pieces
