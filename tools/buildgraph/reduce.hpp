#pragma once
// Leaves candidates that no choice needs out of their list and of their graph.

#include <cstdint>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/mesh/mesh_part.hpp"

namespace hexpipe::buildgraph {

// A neighbour u dominates v when every neighbour of u is a neighbour of v and u weighs at least as much (Lamm, Schulz,
// Strash, Williger, Zhang 2019, weighted domination). A solution with v does not get lighter with u in its place, so v
// can be left out without loss.
//
// The vertices that stay, ascending, when dominated ones are left out one after another until there are none. If two
// dominate each other, the higher one stays.
std::vector<std::int32_t> undominated_vertices(const graph::ConflictGraph& graph);

// Keep only the items of `kept`, which ascends. They work in place, as large data have no room for a copy.
void keep_only(Candidates& candidates, std::span<const std::int32_t> kept);
void keep_only(CandidateKeys& keys, std::span<const std::int32_t> kept);
// The graph that `kept` induces.
void keep_only(graph::ConflictGraph& graph, std::span<const std::int32_t> kept);

// Leaves out dominated candidates. A solution of the remaining graph is a solution of the whole graph, and the heaviest
// one weighs the same. Returns how many candidates were left out.
std::int64_t reduce(Candidates& candidates, graph::ConflictGraph& graph);

}  // namespace hexpipe::buildgraph
