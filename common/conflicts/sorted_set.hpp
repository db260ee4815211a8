#pragma once
// A set of small integers that is filled, listed in order and emptied again and again. Insertion takes two bit
// operations, and listing touches only inserted items. So thousands of insertions, most of them repeated, need no
// sorting.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace hexpipe::conflicts {

class SortedSet {
 public:
  // For integers below `bound`.
  explicit SortedSet(std::size_t bound) : words_(bound / 64 + 1), groups_(bound / 4096 + 1), lowest_(groups_.size()) {}

  void insert(std::int32_t item) {
    const auto i = static_cast<std::uint32_t>(item);
    words_[i >> 6] |= std::uint64_t{1} << (i & 63);
    groups_[i >> 12] |= std::uint64_t{1} << (i >> 6 & 63);
    lowest_ = std::min<std::size_t>(lowest_, i >> 12);
    highest_ = std::max<std::size_t>(highest_, i >> 12);
  }
  void erase(std::int32_t item) {
    const auto i = static_cast<std::uint32_t>(item);
    words_[i >> 6] &= ~(std::uint64_t{1} << (i & 63));
  }

  // Calls visit(item) in ascending order and empties the set.
  template <class Visit>
  void drain(Visit&& visit) {
    for (std::size_t group = lowest_; group <= highest_ && group < groups_.size(); ++group) {
      for (std::uint64_t left = groups_[group]; left != 0; left &= left - 1) {
        const std::size_t word = 64 * group + static_cast<std::size_t>(std::countr_zero(left));
        for (std::uint64_t bits = words_[word]; bits != 0; bits &= bits - 1)
          visit(static_cast<std::int32_t>(64 * word + static_cast<std::size_t>(std::countr_zero(bits))));
        words_[word] = 0;
      }
      groups_[group] = 0;
    }
    lowest_ = groups_.size();
    highest_ = 0;
  }

 private:
  std::vector<std::uint64_t> words_;
  std::vector<std::uint64_t> groups_;  // a bit for each word that may hold items
  std::size_t lowest_, highest_ = 0;   // of the groups in use
};

}  // namespace hexpipe::conflicts
