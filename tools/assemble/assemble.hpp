#pragma once
// From a choice of candidates to the hex-dominant mesh.

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/mixed_mesh.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/selection.hpp"
#include "tools/assemble/statistics.hpp"

namespace hexpipe {

struct AssembleOptions {
  enum class Conformity { pyramids, none };
  Conformity conformity = Conformity::pyramids;
  int smooth = 5;  // rounds over all vertices
};

struct AssembleResult {
  MixedMesh mesh;  // with quality
  AssembleStatistics statistics;
};

// The chosen cells and the tets that remain, with the input's regions and tagged facets; with Conformity::pyramids
// conforming. The result is checked (self_check.hpp) before it is returned.
//
// Throws DataError, with the name of the input, when a tet is not positively oriented, the candidates are not of this
// mesh, or the chosen ones cannot stand together.
AssembleResult assemble(const TetMesh& mesh, const Candidates& candidates, const IndependentSet& chosen,
                        const AssembleOptions& options, const InputNames& names = {});

}  // namespace hexpipe
