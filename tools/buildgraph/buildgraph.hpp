#pragma once
// The conflict graph of candidates, of all or of those that are needed: docs/definitions.md 2 and 5.

#include <optional>

#include "common/conflicts/find_conflicts.hpp"
#include "common/graph/clique_cover.hpp"
#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "tools/buildgraph/neighbours.hpp"

namespace hexpipe::buildgraph {

struct BuildgraphOptions {
  conflicts::ConflictOptions conflicts{};
  bool reduce = false;  // leave out dominated candidates
  bool cover = false;   // find an edge clique cover, from the mesh
};

struct BuildgraphResult {
  graph::ConflictGraph graph;
  std::optional<Candidates> candidates;  // where they were reduced: those that are left, vertex i is candidate i
  std::optional<graph::CliqueCover> cover;
  std::int64_t dominated = 0;  // candidates that were left out
};

// Vertex i is candidate i. Throws DataError naming `source` when weights do not fit (see weights_of) or there are 2^31
// candidates or more.
BuildgraphResult buildgraph(Candidates candidates, const BuildgraphOptions& options, const char* source);

// The same for a part of a mesh, its own candidates and those of its neighbours: of the latter those are left that are
// in conflict with one of its own, and of conflicts those that one of its own is in.
struct PartGraph {
  BuildgraphResult result;
  PartCandidates candidates;  // vertex i is candidate i
};
PartGraph buildgraph_of_part(PartCandidates all, std::int32_t part, const BuildgraphOptions& options,
                             const char* source);

}  // namespace hexpipe::buildgraph
