#pragma once
// Cuts a conflict graph into blocks of about as many vertices with few edges between them.

#include <cstdint>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::lns_mpi {

// The block of each vertex, every block from 0 on used unless there are fewer vertices. Depends on the graph and the
// number of blocks alone.
std::vector<std::int32_t> cut_into_blocks(const graph::ConflictGraph& graph, std::int32_t blocks);

}  // namespace hexpipe::lns_mpi
