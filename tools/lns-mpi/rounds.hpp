#pragma once
// Large neighbourhood search on many machines. In each round, a rank improves the solution in the regions of its blocks
// by the search of lns, then tells its partners what changed near them. Under a time limit alone, a rank searches its
// blocks as one.
//
// The result does not depend on the number of ranks unless a time limit ends the search. The regions, their seeds and
// their numbers of fragments follow from the blocks and the round alone. There are no edges between regions, so it does
// not matter which rank searches which region, and when. All sums over ranks are of integers. The only price is that
// the number of blocks must be given or follow from the graph.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/mwis/local_search/lns.hpp"
#include "common/run/deadline.hpp"
#include "tools/lns-mpi/block_memory.hpp"
#include "tools/lns-mpi/local_graph.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

struct RoundsOptions {
  mwis::local_search::LnsOptions search;  // `iterations` and `target` over all rounds and blocks
  std::int64_t fragments_a_round = 20;    // for a thousand vertices of the whole graph
  // Called with each fragment that this rank improved, as vertices of the local graph; may be empty.
  std::function<void(std::span<const std::int32_t>)> improved;
};

// The same on all ranks.
struct RoundsProgress {
  std::int64_t round = 0;  // rounds done
  std::int64_t weight = 0;
  std::int64_t allotted = 0;      // fragments that rounds were allowed
  std::int64_t iterations = 0;    // fragments solved
  std::int64_t improvements = 0;  // of these
  std::int64_t quiet = 0;         // rounds since a region was improved, or left before its best was proven
};

// The costs of a round on this rank.
struct RoundCosts {
  double search_seconds = 0, wait_seconds = 0;
  Traffic traffic;
};

// Exact reductions in each block alone: takes or leaves out the vertices that can be decided without search, such that
// some heaviest solution agrees. The solution may lose a little weight until the search has caught up. Returns false,
// and decides nothing, if the graph is large and a sample shows that reductions decide too few. All ranks call this
// together.
bool reduce_blocks(Ranks& ranks, LocalGraph& local, const Deadline& deadline);

// Begins with the solution in `local`, or continues from `progress` with the choice of an `earlier` run: its keys,
// ascending, of at least the vertices that this rank owns. A search that was stopped and continued has the same result
// as one that was not. The result is in `local` and is not lighter than the solution there before, in which chosen
// vertices may be neighbours if they are in different blocks. `memories` has an entry for each block of this rank, in
// order; it is empty before the search. `report` is called after every round on all ranks; its last argument is true
// after the last round.
void improve_in_rounds(Ranks& ranks, LocalGraph& local, const RoundsOptions& options, const Deadline& deadline,
                       const std::optional<std::vector<std::uint64_t>>& earlier, RoundsProgress& progress,
                       std::vector<BlockMemory>& memories,
                       const std::function<void(const RoundsProgress&, const RoundCosts&, bool)>& report);

// The weight of all vertices that are chosen, on all ranks together.
std::int64_t total_weight(Ranks& ranks, const LocalGraph& local);

}  // namespace hexpipe::lns_mpi
