#pragma once
// Proves an upper bound on any solution of a graph that is spread over ranks, by certify's clique dual. Each clique
// belongs to the block that found it. In a pass, each block steps through the prices of its cliques. If a vertex is in
// cliques of several blocks, only the prices of one block, drawn for each pass, may move. So every step is exact, and
// ranks send each other only the weights of vertices beyond their prices. In the end prices are whole numbers, and the
// bound is the sum of the prices and of these weights.

#include <cstdint>
#include <vector>

#include "common/run/deadline.hpp"
#include "tools/lns-mpi/local_graph.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

struct SharedProof {
  std::int64_t bound = 0;
  // On the first rank, from each rank in order: the lines of certify's certificate after its first line.
  std::vector<Bytes> prices;
};

// The result is the same on all ranks and for any number of them, unless the deadline comes first. `with_prices`: also
// the prices, for a graph whose keys are the numbers of its vertices.
SharedProof prove_bound(Ranks& ranks, const LocalGraph& local, std::int64_t passes, std::uint64_t seed,
                        const Deadline& deadline, bool with_prices);

}  // namespace hexpipe::lns_mpi
