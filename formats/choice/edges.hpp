#pragma once
// Makes graphs from their edges, and complements of graphs.

#include <cstdint>
#include <string>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::formats {

// `ends` has two vertices for each edge, and no loops. An edge may come several times, in both directions.
graph::ConflictGraph graph_of_edges(std::vector<std::int64_t> weights, const std::vector<std::int32_t>& ends);

// The edges that the graph does not have: its cliques are the independent sets of this one. `source` begins the message
// if the edges do not fit into memory.
graph::ConflictGraph complement_of(const graph::ConflictGraph& graph, const std::string& source);

}  // namespace hexpipe::formats
