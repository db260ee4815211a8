#pragma once
// Where the next fragment is grown, and how large: it remembers what was tried around each chosen vertex.

#include <cstdint>
#include <optional>
#include <vector>

#include "common/run/random.hpp"

namespace hexpipe::mwis::local_search {

// Any chosen vertex is a possible seed of a fragment. The next seed is one of those around which the fewest fragments
// were solved since the solution last changed there, drawn at random. So the whole graph is worked through before
// anything is tried again. Where a fragment is solved completely without a gain, the next one is larger; where it is
// not solved completely, smaller (Verhetsel 2017, algorithm 12, but for each place by itself).
class Schedule {
 public:
  // Places with more tries are not distinguished: each number of tries has its own list.
  static constexpr std::uint32_t most_tries = 1 << 16;

  // No vertex waits as a seed yet. Sizes are numbers of free vertices.
  Schedule(std::size_t vertices, std::size_t first_size, std::size_t largest_size, Random random);

  // The next seed; nullopt if none waits. It does not wait any more until renew, retire or wait.
  std::optional<std::int32_t> take();

  // v waits as a seed with no tries around it.
  void renew(std::int32_t v);
  // v waits as a seed with one more try around it.
  void retire(std::int32_t v);
  // v waits as it did before.
  void wait(std::int32_t v);
  // v waits as a seed with this many tries from an earlier search; its next fragment has this size.
  void recall(std::int32_t v, std::uint32_t tries, std::uint32_t size);
  // v is no longer a seed.
  void close(std::int32_t v) { places_[v].closed = true; }

  // The fragments tried around v since it was renewed.
  std::uint32_t tries_at(std::int32_t v) const { return places_[v].tries; }
  std::size_t size_at(std::int32_t v) const { return places_[v].size; }
  void set_size(std::int32_t v, std::size_t size) { places_[v].size = static_cast<std::uint32_t>(size); }
  void enlarge(std::int32_t v);
  void shrink(std::int32_t v);

 private:
  static constexpr std::uint32_t smallest_size = 16;

  struct Place {
    std::uint32_t tries;
    std::uint32_t waiting_at;  // the number of tries under which it waits
    std::uint32_t size;
    bool closed;
  };

  std::size_t largest_size_;
  Random random_;
  std::vector<Place> places_;
  // By the number of tries. An entry counts only if its vertex waits under that number.
  std::vector<std::vector<std::int32_t>> waiting_;
  std::size_t lowest_ = 0;
};

}  // namespace hexpipe::mwis::local_search
