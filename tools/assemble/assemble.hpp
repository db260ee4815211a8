#pragma once
// From a choice of candidates to the hex-dominant mesh: of a whole mesh, or of one part of a mesh (docs/definitions.md
// 5).

#include <string>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/mesh_piece.hpp"
#include "common/mesh/mixed_mesh.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/attempt.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/options.hpp"
#include "tools/assemble/pieces/part_view.hpp"
#include "tools/assemble/statistics.hpp"

namespace hexpipe::assemble {

struct AssembleResult {
  MixedMesh mesh;  // with quality
  AssembleStatistics statistics;
  // By point: its vertex in the input, or for an added point a number from the input's number of points on.
  std::vector<Vertex> origin;
  std::vector<CandidateIndex> left;  // the candidates that are cells of the mesh, ascending
};

// Throws DataError, with the mesh's name and the number of the tet from 1, if one is not positively oriented.
void check_orientation(const TetMesh& mesh, const choice::InputNames& names);

// The chosen cells, or others in exchange, and the tets that remain, with the input's regions and tagged facets; with
// Conformity::pyramids conforming; and the layers that are asked for. The result is checked (self_check.hpp) before it
// is returned.
//
// Throws DataError, with the name of the input, if a tet is not positively oriented, if candidates are not of this
// mesh, if chosen ones do not fit together or are not valid, or if the mesh has no such walls.
AssembleResult assemble(TetMesh mesh, const Candidates& candidates, const graph::IndependentSet& solution,
                        const AssembleOptions& options, const choice::InputNames& names = {},
                        const LayerOptions& layers = {});

// The rules for a whole mesh, which has no seam.
BuildRules build_rules(const AssembleOptions& options);

// The piece of one part, conforming, from all `cells`. The surface of `mesh` is complete, with the seam's own tags; the
// seam is in the rules. The result is without guests and without facets that have the seam's tags. Throws as assemble()
// does.
AssembleResult assemble_piece(TetMesh mesh, const Candidates& cells, const BuildRules& rules,
                              const choice::InputNames& names);

struct PartResult {
  MixedMesh mesh;
  AssembleStatistics statistics;
  MeshPiece piece;
};

// The piece of the view's own part, after the pieces that the previous round made of this part and its neighbours:
// paths in `before`, among which other pieces are skipped; empty in the first round. Throws as assemble() does, and if
// a piece is missing or of another mesh. `rules` without a seam; `names` are those of the part's own bundle.
PartResult assemble_part(pieces::PartView view, const std::vector<std::string>& before, BuildRules rules,
                         const choice::InputNames& names);

}  // namespace hexpipe::assemble
