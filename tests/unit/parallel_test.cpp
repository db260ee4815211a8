#include "common/run/parallel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace hexpipe {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
  std::vector<std::atomic<int>> visits(10001);
  parallel_for(10001, 7, [&](std::int64_t i) { ++visits[i]; });
  for (const auto& count : visits) EXPECT_EQ(count, 1);
}

TEST(ParallelInOrder, PutsBlocksTogetherInTheirOrderForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    std::vector<std::int64_t> all;
    parallel_in_order(
        1003, 10,
        [](std::int64_t begin, std::int64_t end) {
          std::vector<std::int64_t> block(end - begin);
          std::iota(block.begin(), block.end(), begin);
          return block;
        },
        [&](std::vector<std::int64_t>&& block) { all.insert(all.end(), block.begin(), block.end()); });
    std::vector<std::int64_t> expected(1003);
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(all, expected);
  }
}

TEST(ParallelInOrder, NothingToDoCallsNobody) {
  parallel_in_order(
      0, 10, [](std::int64_t, std::int64_t) -> int { throw std::logic_error("called"); },
      [](int) { throw std::logic_error("called"); });
}

TEST(ParallelInOrder, AnExceptionComesOut) {
  EXPECT_THROW(parallel_in_order(
                   100, 10,
                   [](std::int64_t begin, std::int64_t) -> int {
                     if (begin == 50) throw std::runtime_error("block 50");
                     return 0;
                   },
                   [](int) {}),
               std::runtime_error);
}

TEST(ParallelCollect, KeepsTheOrder) {
  const auto all = parallel_collect<std::int64_t>(103, 10, [](std::int64_t i, std::vector<std::int64_t>& found) {
    if (i % 2 == 0) found.push_back(i);
  });
  ASSERT_EQ(all.size(), 52);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], 2 * static_cast<std::int64_t>(i));
}

TEST(ThreadLimit, HoldsWhileItStands) {
  const ThreadLimit limit(1);
  EXPECT_EQ(thread_count(), 1);
}

}  // namespace
}  // namespace hexpipe
