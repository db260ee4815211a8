#pragma once
// Large neighbourhood search on many machines: in rounds, each rank improves the solution in the regions of its blocks
// by the search of lns, then tells its partners what changed near them.
//
// The result does not depend on the number of ranks unless a time limit ends the search: which regions there are, and
// the seed and the number of fragments for each, follow from the blocks and the round alone; regions have no edges
// between them, so it does not matter who searches which and when; and the only numbers that are put together are
// whole. That costs nothing but that the number of blocks must be given, or follow from the graph.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/mwis/local_search/lns.hpp"
#include "common/run/deadline.hpp"
#include "tools/lns-mpi/block_memory.hpp"
#include "tools/lns-mpi/piece.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe::lns_mpi {

struct RoundsOptions {
  mwis::local_search::LnsOptions search;  // `iterations` and `target` over all rounds and blocks
  std::int64_t fragments_a_round = 20;    // for a thousand vertices of the whole graph
  // Called with what this rank improved, by vertices of the piece; may be empty.
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

// What a round took of this rank.
struct RoundCosts {
  double search_seconds = 0, wait_seconds = 0;
  Traffic traffic;
};

// From the solution in `piece` on, or from what an `earlier` run chose (keys, ascending, of at least the vertices that
// this rank owns), where `progress` says: the same whether or not it was stopped in between, and not lighter than what
// is in `piece`. Chosen vertices may be neighbours where they are in different blocks. `memories` are of the blocks of
// this rank, in order, and empty where nothing was searched. `report` is called after every round, on all ranks, and
// told whether it was the last one.
void improve_in_rounds(Ranks& ranks, Piece& piece, const RoundsOptions& options, const Deadline& deadline,
                       const std::optional<std::vector<std::uint64_t>>& earlier, RoundsProgress& progress,
                       std::vector<BlockMemory>& memories,
                       const std::function<void(const RoundsProgress&, const RoundCosts&, bool)>& report);

// Of the vertices that all ranks own, together.
std::int64_t total_weight(Ranks& ranks, const Piece& piece);

}  // namespace hexpipe::lns_mpi
