// Sets of small numbers as bits.

#include "common/mwis/ground/bits.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace hexpipe::mwis::bits {
namespace {

TEST(Bits, CountsTheMembersBetweenTwoNumbers) {
  std::mt19937_64 random(7);
  const std::array<Word, 3> set{random(), random(), random()};
  for (std::size_t begin = 0; begin <= 192; ++begin)
    for (std::size_t end = begin; end <= 192; ++end) {
      std::size_t members = 0;
      for (std::size_t i = begin; i < end; ++i) members += test(set.data(), i) ? 1 : 0;
      EXPECT_EQ(count_between(set.data(), begin, end), members) << begin << " to " << end;
    }
}

}  // namespace
}  // namespace hexpipe::mwis::bits
