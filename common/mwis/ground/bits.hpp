#pragma once
// Sets of small numbers as rows of 64-bit words.

#include <bit>
#include <cstddef>
#include <cstdint>

namespace hexpipe::mwis::bits {

using Word = std::uint64_t;

constexpr std::size_t words_for(std::size_t count) {
  return (count + 63) / 64;
}
constexpr bool test(const Word* set, std::size_t i) {
  return (set[i / 64] >> (i % 64) & 1) != 0;
}
constexpr void insert(Word* set, std::size_t i) {
  set[i / 64] |= Word{1} << (i % 64);
}
constexpr void erase(Word* set, std::size_t i) {
  set[i / 64] &= ~(Word{1} << (i % 64));
}

// {0, 1, ..., count-1}
constexpr void fill(Word* set, std::size_t count) {
  const std::size_t words = words_for(count);
  for (std::size_t w = 0; w < words; ++w) set[w] = ~Word{0};
  if (count % 64 != 0) set[words - 1] = (Word{1} << (count % 64)) - 1;
}

constexpr bool empty(const Word* set, std::size_t words) {
  for (std::size_t w = 0; w < words; ++w)
    if (set[w] != 0) return false;
  return true;
}

constexpr std::size_t count(const Word* set, std::size_t words) {
  std::size_t sum = 0;
  for (std::size_t w = 0; w < words; ++w) sum += static_cast<std::size_t>(std::popcount(set[w]));
  return sum;
}

// The number of members from begin to end.
constexpr std::size_t count_between(const Word* set, std::size_t begin, std::size_t end) {
  std::size_t sum = 0;
  for (std::size_t w = begin / 64; 64 * w < end; ++w) {
    Word word = set[w];
    if (w == begin / 64) word &= ~Word{0} << (begin % 64);
    if (end < 64 * (w + 1)) word &= ~(~Word{0} << (end % 64));
    sum += static_cast<std::size_t>(std::popcount(word));
  }
  return sum;
}

// Calls visit(i) for every member, ascending. Members that `visit` erases from later words are skipped.
template <class Visit>
constexpr void for_each(const Word* set, std::size_t words, Visit&& visit) {
  for (std::size_t w = 0; w < words; ++w)
    for (Word word = set[w]; word != 0; word &= word - 1)
      visit(64 * w + static_cast<std::size_t>(std::countr_zero(word)));
}

// Like for_each, until visit returns false; returns false if it did.
template <class Visit>
constexpr bool all_of(const Word* set, std::size_t words, Visit&& visit) {
  for (std::size_t w = 0; w < words; ++w)
    for (Word word = set[w]; word != 0; word &= word - 1)
      if (!visit(64 * w + static_cast<std::size_t>(std::countr_zero(word)))) return false;
  return true;
}

}  // namespace hexpipe::mwis::bits
