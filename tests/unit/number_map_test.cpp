#include "formats/streams/number_map.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <unordered_map>

#include "common/run/random.hpp"

namespace hexpipe {
using namespace formats;
namespace {

void expect_found(const std::vector<std::int64_t>& numbers) {
  const NumberMap map(numbers);
  EXPECT_EQ(map.repeated(), std::nullopt);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    EXPECT_EQ(map.find(numbers[i]), static_cast<std::int32_t>(i)) << numbers[i];
}

TEST(NumberMap, FindsNumbersInSequence) {
  expect_found({1, 2, 3, 4});
  const NumberMap map({5, 6, 7});
  for (const std::int64_t absent :
       {std::int64_t{4}, std::int64_t{8}, std::int64_t{0}, std::int64_t{-1}, std::numeric_limits<std::int64_t>::max()})
    EXPECT_EQ(map.find(absent), no_index);
}

TEST(NumberMap, FindsNumbersThatLieClose) {
  expect_found({7, 3, 5, 9});
  const NumberMap map({7, 3, 5, 9});
  for (const std::int64_t absent : {2, 4, 6, 8, 10, 1000}) EXPECT_EQ(map.find(absent), no_index);
}

TEST(NumberMap, FindsNumbersFarApart) {
  const std::int64_t greatest = std::numeric_limits<std::int64_t>::max();
  expect_found({greatest, 0, 1, 5000000000});
  const NumberMap map({greatest, 0, 5000000000});
  for (const std::int64_t absent : {std::int64_t{1}, greatest - 1, std::int64_t{-1}})
    EXPECT_EQ(map.find(absent), no_index);
}

TEST(NumberMap, TellsARepeatedNumber) {
  EXPECT_EQ(NumberMap({3, 1, 2, 1}).repeated(), 1);
  EXPECT_EQ(NumberMap({3, 5000000000, 2, 5000000000}).repeated(), 5000000000);
  EXPECT_EQ(NumberMap({4, 4}).repeated(), 4);
}

TEST(NumberMap, IsEmptyWithoutNumbers) {
  EXPECT_EQ(NumberMap().find(0), no_index);
  EXPECT_EQ(NumberMap(std::vector<std::int64_t>{}).find(0), no_index);
}

TEST(NumberMap, AgreesWithAHashTable) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    const std::uint64_t range = 1 + random.below(round % 2 == 0 ? 60 : 2000);
    std::unordered_map<std::int64_t, std::int32_t> expected;
    std::vector<std::int64_t> numbers;
    for (std::uint64_t k = random.below(50); k > 0; --k) {
      const auto number = static_cast<std::int64_t>(random.below(range));
      if (expected.emplace(number, static_cast<std::int32_t>(numbers.size())).second) numbers.push_back(number);
    }
    const NumberMap map(numbers);
    for (std::int64_t number = 0; number < static_cast<std::int64_t>(range); ++number) {
      const auto found = expected.find(number);
      ASSERT_EQ(map.find(number), found == expected.end() ? no_index : found->second) << "round " << round;
    }
  }
}

}  // namespace
}  // namespace hexpipe
