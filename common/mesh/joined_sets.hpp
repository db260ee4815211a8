#pragma once
// Disjoint sets of the numbers from 0, which are joined step by step.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace hexpipe {

class JoinedSets {
 public:
  explicit JoinedSets(std::size_t count = 0) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  // Adds the next number, as a set of its own.
  std::int32_t add() {
    parent_.push_back(static_cast<std::int32_t>(parent_.size()));
    return parent_.back();
  }
  // The set of i, by its lowest number.
  std::int32_t of(std::int32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::int32_t i, std::int32_t j) {
    i = of(i), j = of(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace hexpipe
