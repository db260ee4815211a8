#pragma once
// Checks that all ranks hold parts of one graph, and that a checkpoint belongs to the same graph. It compares sums of
// hashes, which do not depend on which rank holds what.

#include <cstdint>

#include "tools/lns-mpi/local_graph.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

// The fingerprint of vertices, weights, edges and blocks of all ranks together.
std::uint64_t fingerprint_of(Ranks& ranks, const OwnedRows& rows);

// Throws DataError on all ranks when an edge between two blocks is in the rows of only one of its ends; the message
// names the blocks.
void expect_agreement(Ranks& ranks, const BlockOwners& owners, const OwnedRows& rows);

}  // namespace hexpipe::lns_mpi
