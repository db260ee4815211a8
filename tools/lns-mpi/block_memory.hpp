#pragma once
// Keeps what a block's search has learnt of the places that it tried, from one round to the next.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/mwis/local_search/lns.hpp"
#include "common/mwis/local_search/schedule.hpp"
#include "tools/lns-mpi/regions.hpp"

namespace hexpipe::lns_mpi {

class BlockMemory {
 public:
  struct Place {
    std::uint64_t key;
    std::array<std::uint32_t, mwis::local_search::all_operators.size()> tries;
    std::uint32_t size;
  };

  BlockMemory() = default;
  BlockMemory(std::vector<Place> places, const mwis::local_search::OperatorScores& operator_scores)
      : places_(std::move(places)), operator_scores_(operator_scores) {}

  // The knowledge about this region, in its numbers; `keys` are those of the rank's local graph.
  mwis::local_search::LnsMemory recall(const Region& region, std::span<const std::uint64_t> keys) const;
  void remember(const mwis::local_search::LnsMemory& memory, const Region& region, std::span<const std::uint64_t> keys);
  // Places of these keys, ascending, count as never tried; the size of their fragments stays.
  void forget_tries(std::span<const std::uint64_t> keys);

  // The size that fragments have reached; 0: nothing is known.
  std::size_t usual_size() const;

  // Takes what the others, of other places, have learnt.
  void join(std::span<const BlockMemory> others);

  const std::vector<Place>& places() const { return places_; }
  const mwis::local_search::OperatorScores& operator_scores() const { return operator_scores_; }

 private:
  std::vector<Place> places_;  // ascending
  mwis::local_search::OperatorScores operator_scores_;
};

}  // namespace hexpipe::lns_mpi
