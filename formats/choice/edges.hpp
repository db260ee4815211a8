#pragma once
// Graphs from their edges, and what is made of whole graphs.

#include <cstdint>
#include <string>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::formats {

// `ends` has two vertices for each edge, no loops among them; an edge may come several times, in both directions.
graph::ConflictGraph graph_of_edges(std::vector<std::int64_t> weights, const std::vector<std::int32_t>& ends);

// The edges that the graph does not have: its cliques are the independent sets of this one. `source` is for the
// message where there is no memory for so many.
graph::ConflictGraph complement_of(const graph::ConflictGraph& graph, const std::string& source);

}  // namespace hexpipe::formats
