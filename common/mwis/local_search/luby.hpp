#pragma once
// The sequence 1, 1, 2, 1, 1, 2, 4, ...: how long the runs of a search that begins anew are. Each length gets the same
// time in all (Luby, Sinclair, Zuckerman 1993), because nobody knows which one suits the graph.

#include <bit>
#include <cstdint>

namespace hexpipe::mwis::local_search {

// The i-th of them, from 1.
constexpr std::int64_t luby(std::int64_t i) {
  for (auto k = static_cast<std::uint64_t>(i);;) {
    const std::uint64_t next = std::bit_ceil(k + 1);
    if (k + 1 == next) return static_cast<std::int64_t>(next / 2);
    k -= next / 2 - 1;
  }
}

}  // namespace hexpipe::mwis::local_search
