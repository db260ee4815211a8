#pragma once
// Assembles the piece of one part of a mesh: docs/definitions.md 5.

#include <string>
#include <vector>

#include "common/mesh/mesh_piece.hpp"
#include "tools/assemble/assemble.hpp"
#include "tools/assemble/pieces/part_view.hpp"

namespace hexpipe::assemble {

struct PartResult {
  MixedMesh mesh;
  AssembleStatistics statistics;
  MeshPiece piece;
};

// `before`: what the round before made of this part and its neighbours, others are skipped; empty in the first round.
// Throws DataError as assemble does, and when a piece is missing or of another mesh.
// `names` of the part's own bundle.
PartResult assemble_part(pieces::PartView view, const std::vector<std::string>& before, const AssembleOptions& options,
                         const choice::InputNames& names);

}  // namespace hexpipe::assemble
