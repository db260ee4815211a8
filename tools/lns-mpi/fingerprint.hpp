#pragma once
// Whether all ranks hold parts of one graph, and the same that a checkpoint was made of: sums of mixed numbers, which
// do not depend on who holds what.

#include <cstdint>

#include "tools/lns-mpi/piece.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

// Of vertices, weights, edges and blocks of all ranks together.
std::uint64_t fingerprint_of(Ranks& ranks, const OwnedRows& rows);

// Throws DataError on all ranks that names two blocks where an edge between them is in the rows of one of its ends
// alone.
void expect_agreement(Ranks& ranks, const BlockOwners& owners, const OwnedRows& rows);

}  // namespace hexpipe::lns_mpi
