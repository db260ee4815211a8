#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

#include "common/conflicts/packed_lists.hpp"

namespace hexpipe {
using namespace conflicts;
namespace {

using Items = std::vector<std::pair<std::int64_t, std::int32_t>>;

TEST(PackedLists, GiveBackWhatTheyWereGiven) {
  constexpr std::int32_t greatest = std::numeric_limits<std::int32_t>::max();
  const std::vector<std::vector<std::int32_t>> lists{
      {0, 1, 2}, {}, {}, {126, 127, 128, 255, 256}, {0, 16383, 16384, 32768}, {greatest}, {0, greatest}, {5}, {}};
  PackedLists packed;
  Items expected, found;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    for (const std::int32_t item : lists[i]) {
      packed.add(item);
      expected.emplace_back(7 + i, item);
    }
    packed.end_list();
  }
  packed.for_each(7, [&](std::int64_t list, std::int32_t item) { found.emplace_back(list, item); });
  EXPECT_EQ(found, expected);
}

TEST(PackedLists, OfNothing) {
  PackedLists().for_each(0, [](std::int64_t, std::int32_t) { FAIL(); });
}

}  // namespace
}  // namespace hexpipe
