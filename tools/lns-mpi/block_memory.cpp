#include "tools/lns-mpi/block_memory.hpp"

#include <algorithm>

namespace hexpipe::lns_mpi {

mwis::local_search::LnsMemory BlockMemory::recall(const Region& region, std::span<const std::uint64_t> keys) const {
  mwis::local_search::LnsMemory memory;
  memory.operator_scores = operator_scores_;
  auto known = places_.begin();
  for (const std::int32_t v : region.chosen) {
    const std::uint64_t key = keys[region.vertices[v]];
    while (known != places_.end() && known->key < key) ++known;
    if (known != places_.end() && known->key == key) memory.places.push_back({v, known->tries, known->size});
  }
  return memory;
}

void BlockMemory::remember(const mwis::local_search::LnsMemory& memory, const Region& region,
                           std::span<const std::uint64_t> keys) {
  operator_scores_ = memory.operator_scores;
  // Places outside of the region stay known: borders move to and fro.
  auto inside = region.vertices.begin();
  std::erase_if(places_, [&](const Place& place) {
    while (inside != region.vertices.end() && keys[*inside] < place.key) ++inside;
    return inside != region.vertices.end() && keys[*inside] == place.key;
  });
  for (const mwis::local_search::LnsMemory::Place& place : memory.places)
    places_.push_back({keys[region.vertices[place.vertex]], place.tries, place.size});
  std::ranges::sort(places_, {}, &Place::key);
}

void BlockMemory::forget_tries(std::span<const std::uint64_t> keys) {
  auto known = places_.begin();
  for (const std::uint64_t key : keys) {
    while (known != places_.end() && known->key < key) ++known;
    if (known != places_.end() && known->key == key) known->tries.fill(0);
  }
}

// How operators have done is of this one, because credit is of work that was done after each other.
void BlockMemory::join(std::span<const BlockMemory> others) {
  for (const BlockMemory& other : others) places_.insert(places_.end(), other.places_.begin(), other.places_.end());
  std::ranges::sort(places_, {}, &Place::key);
  const auto repeated = std::ranges::unique(places_, {}, &Place::key);
  places_.erase(repeated.begin(), repeated.end());
}

std::size_t BlockMemory::usual_size() const {
  if (places_.empty()) return 0;
  std::size_t sum = 0;
  for (const Place& place : places_) sum += place.size;
  return sum / places_.size();
}

}  // namespace hexpipe::lns_mpi
