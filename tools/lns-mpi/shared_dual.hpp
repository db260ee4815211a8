#pragma once
// An upper bound on any solution of a graph that is spread over ranks: certify's clique dual, each clique with the
// block that found it. In a pass each block steps through the prices of its cliques; where a vertex is in cliques of
// several blocks, those of one block, drawn for each pass, alone may move, so that every step is exact and what a
// vertex weighs beyond its prices is all that travels. In the end prices are whole, and the bound is their sum and what
// is left.

#include <cstdint>
#include <vector>

#include "common/run/deadline.hpp"
#include "tools/lns-mpi/piece.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

struct SharedProof {
  std::int64_t bound = 0;
  // On the first rank, from each rank in order: the lines behind the first of a certificate, as certify writes it.
  std::vector<Bytes> prices;
};

// The same on all ranks and for any number of them, unless the deadline comes first. Prices come `with_prices` alone,
// for a graph whose keys are the numbers of its vertices.
SharedProof prove_bound(Ranks& ranks, const Piece& piece, std::int64_t passes, std::uint64_t seed,
                        const Deadline& deadline, bool with_prices);

}  // namespace hexpipe::lns_mpi
