#pragma once
// Cuts a conflict graph into blocks of about the same size, with few edges between them.

#include <cstdint>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::lns_mpi {

// The block of each vertex. Every block from 0 on is used unless there are fewer vertices. Depends only on the graph
// and the number of blocks.
std::vector<std::int32_t> cut_into_blocks(const graph::ConflictGraph& graph, std::int32_t blocks);

}  // namespace hexpipe::lns_mpi
