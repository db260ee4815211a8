#pragma once
// Candidates that no choice needs, left out of their list and of their graph alike.

#include <cstdint>
#include <span>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/mesh_part.hpp"

namespace hexpipe::buildgraph {

// Those of `kept`, ascending, in place: what is large has no room for another.
void keep_only(Candidates& candidates, std::span<const std::int32_t> kept);
void keep_only(CandidateKeys& keys, std::span<const std::int32_t> kept);
// The graph of them.
void keep_only(graph::ConflictGraph& graph, std::span<const std::int32_t> kept);

// Leaves out what is dominated (domination.hpp). A solution of the graph that is left is one of the whole graph, of the
// candidates that are left, and the heaviest one weighs the same. Returns how many candidates were left out.
std::int64_t reduce(Candidates& candidates, graph::ConflictGraph& graph);

}  // namespace hexpipe::buildgraph
