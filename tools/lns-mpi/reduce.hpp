#pragma once
// Exact reductions before the search, once for all rounds.

#include "common/run/deadline.hpp"
#include "tools/lns-mpi/piece.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

// Takes and leaves out what can be decided without search, in each block alone: some heaviest solution agrees with it.
// The solution may lose a little until the search has caught up. All ranks call this together.
void reduce_blocks(Ranks& ranks, Piece& piece, const Deadline& deadline);

}  // namespace hexpipe::lns_mpi
