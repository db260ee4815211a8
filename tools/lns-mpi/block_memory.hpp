#pragma once
// What the search of a block remembers from one round to the next: how often it tried each chosen vertex, how large
// fragments have become there, and how well its operators did. Vertices are known by their keys, the numbers that do
// not depend on the rank.

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
  // LnsMemory::Place, with the vertex's key.
  struct Place {
    std::uint64_t key;
    std::array<std::uint32_t, mwis::local_search::all_operators.size()> tries;
    std::uint32_t size;
  };

  BlockMemory() = default;
  BlockMemory(std::vector<Place> places, const mwis::local_search::OperatorScores& operator_scores)
      : places_(std::move(places)), operator_scores_(operator_scores) {}

  // What is known about a region, with the vertices' numbers in it. `keys` are those of the rank's local graph, by
  // vertex.
  mwis::local_search::LnsMemory recall(const Region& region, std::span<const std::uint64_t> keys) const;
  // Takes what a search of the region has learnt. Places outside of the region stay.
  void remember(const mwis::local_search::LnsMemory& memory, const Region& region, std::span<const std::uint64_t> keys);
  // Places of these keys, ascending, count as never tried; the size of their fragments stays.
  void forget_tries(std::span<const std::uint64_t> keys);

  // The mean size of the next exact fragments, in free vertices; 0: nothing is known.
  std::size_t usual_size() const;

  // Adds what other blocks have learnt, whose places are others.
  void join(std::span<const BlockMemory> others);

  const std::vector<Place>& places() const { return places_; }
  const mwis::local_search::OperatorScores& operator_scores() const { return operator_scores_; }

 private:
  std::vector<Place> places_;  // by ascending key
  mwis::local_search::OperatorScores operator_scores_;
};

}  // namespace hexpipe::lns_mpi
