#pragma once
// Where the next fragment is grown, and how large: memory of what was tried around each chosen vertex.

#include <cstdint>
#include <optional>
#include <vector>

#include "common/run/random.hpp"

namespace hexpipe::mwis::local_search {

// A chosen vertex is a possible seed. Seeds around which fewest fragments were solved since the solution last changed
// there go first, in random order, so that the whole graph is worked through before anything is tried again; where
// fragments are solved to the end without gain the next ones are larger, where they are not they are smaller (Verhetsel
// 2017, algorithm 12, kept per place).
class Schedule {
 public:
  // Places are told apart by no more tries: there is a list for each number.
  static constexpr std::uint32_t most_tries = 1 << 16;

  // No seed waits at first.
  Schedule(std::size_t vertices, std::size_t first_size, std::size_t largest_size, Random random);

  // The next seed; it waits no more until renew, retire or wait. Empty when none waits.
  std::optional<std::int32_t> take();

  // v waits as a seed around which nothing was tried.
  void renew(std::int32_t v);
  // v waits as a seed around which one fragment more was tried.
  void retire(std::int32_t v);
  // v waits as it did before.
  void wait(std::int32_t v);
  // v waits as a seed around which so many fragments were tried in an earlier search, and the next one has this size.
  void recall(std::int32_t v, std::uint32_t tries, std::uint32_t size);
  // v is no seed any more.
  void close(std::int32_t v) { places_[v].closed = true; }

  // Fragments tried around v since it was renewed.
  std::uint32_t tries_at(std::int32_t v) const { return places_[v].tries; }
  std::size_t size_at(std::int32_t v) const { return places_[v].size; }
  void set_size(std::int32_t v, std::size_t size) { places_[v].size = static_cast<std::uint32_t>(size); }
  void enlarge(std::int32_t v);
  void shrink(std::int32_t v);

 private:
  static constexpr std::uint32_t smallest_size = 16;

  struct Place {
    std::uint32_t tries;
    std::uint32_t waiting_at;  // the tries under which it waits
    std::uint32_t size;
    bool closed;
  };

  std::size_t largest_size_;
  Random random_;
  std::vector<Place> places_;
  // By the number of tries. An entry counts only where its vertex waits under that number.
  std::vector<std::vector<std::int32_t>> waiting_;
  std::size_t lowest_ = 0;
};

}  // namespace hexpipe::mwis::local_search
