#pragma once
// Finds vertices that no search needs: a neighbour u dominates v when every neighbour of u is a neighbour of v and u
// weighs at least as much (Lamm, Schulz, Strash, Williger, Zhang 2019, weighted domination). A solution with v does not
// get lighter with u in its place, so v can be left out without loss.

#include <cstdint>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::buildgraph {

// The vertices that stay, ascending, when dominated ones are left out one after another until there are none. If two
// dominate each other, the higher one stays.
std::vector<std::int32_t> undominated_vertices(const graph::ConflictGraph& graph);

}  // namespace hexpipe::buildgraph
