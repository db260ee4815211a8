#pragma once
// The conflict graph of candidates: docs/definitions.md 2.

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/run/part.hpp"
#include "tools/buildgraph/weights.hpp"

namespace hexpipe {

struct BuildgraphOptions {
  WeightKind weight = WeightKind::quality;
  double weight_scale = 1e6;
  Part part{};  // only conflicts whose higher end is in this part of the candidates
};

// Vertex i is candidate i. Throws DataError naming `source` when weights do not fit (see weights_of) or there are 2^31
// candidates or more. Candidates that are moved in are gone before the graph takes its memory.
ConflictGraph buildgraph(Candidates candidates, const BuildgraphOptions& options, const char* source);

}  // namespace hexpipe
