#pragma once
// Subgraphs of a conflict graph as graphs of their own.

#include <cstdint>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::graph {

// The subgraph that `vertices` induce. They ascend, and are renumbered in this order.
ConflictGraph induced_subgraph(const ConflictGraph& graph, std::span<const std::int32_t> vertices);

// The vertices of each connected component, ascending; the smallest component first.
std::vector<std::vector<std::int32_t>> connected_components(const ConflictGraph& graph);

}  // namespace hexpipe::graph
