#pragma once
// Exact reductions before the search, for all rounds.

#include "common/run/deadline.hpp"
#include "tools/lns-mpi/local_graph.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

// In each block alone, takes or leaves out the vertices that can be decided without search, so that some heaviest
// solution agrees. The solution may lose a little until the search has caught up. All ranks call this together.
void reduce_blocks(Ranks& ranks, LocalGraph& local, const Deadline& deadline);

}  // namespace hexpipe::lns_mpi
