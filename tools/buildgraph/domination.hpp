#pragma once
// Vertices that no search needs: v is dominated by a neighbour u when every neighbour of u is one of v and u weighs at
// least as much (Lamm, Schulz, Strash, Williger, Zhang 2019, weighted domination). A solution with v is no worse with u
// in its place, so that v can be left out, exactly.

#include <cstdint>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::buildgraph {

// The vertices that stay, ascending, once dominated ones are left out one after another until none is left. Of two that
// dominate each other the higher one stays.
std::vector<std::int32_t> undominated_vertices(const graph::ConflictGraph& graph);

}  // namespace hexpipe::buildgraph
