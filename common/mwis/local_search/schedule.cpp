#include "common/mwis/local_search/schedule.hpp"

#include <algorithm>
#include <limits>

namespace hexpipe::mwis::local_search {
namespace {

constexpr std::uint32_t not_waiting = std::numeric_limits<std::uint32_t>::max();

}  // namespace

Schedule::Schedule(std::size_t vertices, std::size_t first_size, std::size_t largest_size, Random random)
    : largest_size_(largest_size),
      random_(random),
      places_(vertices, Place{0, not_waiting, static_cast<std::uint32_t>(std::min(first_size, largest_size)), false}) {}

std::optional<std::int32_t> Schedule::take() {
  for (; lowest_ < waiting_.size(); ++lowest_) {
    auto& list = waiting_[lowest_];
    while (!list.empty()) {
      std::swap(list[random_.below(list.size())], list.back());
      const std::int32_t v = list.back();
      list.pop_back();
      if (places_[v].waiting_at != lowest_ || places_[v].closed) continue;
      places_[v].waiting_at = not_waiting;
      return v;
    }
  }
  return std::nullopt;
}

void Schedule::renew(std::int32_t v) {
  places_[v].tries = 0;
  wait(v);
}

void Schedule::retire(std::int32_t v) {
  places_[v].tries = std::min(places_[v].tries + 1, most_tries);
  wait(v);
}

void Schedule::wait(std::int32_t v) {
  Place& place = places_[v];
  if (place.closed || place.waiting_at == place.tries) return;
  place.waiting_at = place.tries;
  if (waiting_.size() <= place.tries) waiting_.resize(place.tries + 1);
  waiting_[place.tries].push_back(v);
  lowest_ = std::min<std::size_t>(lowest_, place.tries);
}

void Schedule::recall(std::int32_t v, std::uint32_t tries, std::uint32_t size) {
  places_[v].tries = std::min(tries, most_tries);
  places_[v].size = std::min(size, static_cast<std::uint32_t>(largest_size_));
  wait(v);
}

// These factors are common gentle ones. Growing must be the slower of the two per unit of time, because a larger
// fragment costs more.
void Schedule::enlarge(std::int32_t v) {
  places_[v].size = static_cast<std::uint32_t>(std::min<std::size_t>(largest_size_, places_[v].size * 5 / 4 + 1));
}

void Schedule::shrink(std::int32_t v) {
  const std::uint32_t size = places_[v].size;
  places_[v].size = std::min(size, std::max(smallest_size, size * 3 / 4));
}

}  // namespace hexpipe::mwis::local_search
