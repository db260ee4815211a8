#include "common/mwis/local_search/push_tabu.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "random_graphs.hpp"

namespace hexpipe {
using namespace graph;
using namespace mwis::local_search;
namespace {

using hexpipe::testing::make_graph;
using hexpipe::testing::no_deadline;

// What the gains are by definition, while vertices come in, go out and are barred at random.
void check_gains(const ConflictGraph& graph, Random& random) {
  const mwis::ground::DenseGraph dense = mwis::ground::dense_graph_of(graph);
  const auto gains = PushGains::make(dense);
  std::vector<char> chosen(dense.size(), 0), barred(dense.size(), 0);
  for (int round = 0; round < 40; ++round) {
    for (std::uint64_t changes = random.below(7); changes > 0; --changes) {
      const std::size_t v = random.below(dense.size());
      chosen[v] != 0 ? gains->go_out(v) : gains->come_in(v);
      chosen[v] ^= 1;
    }
    const std::size_t other = random.below(dense.size());
    barred[other] != 0 ? gains->free(other) : gains->bar(other);
    barred[other] ^= 1;
    const std::optional<std::int64_t> greatest = gains->settle();
    std::optional<std::int64_t> expected;
    for (std::size_t v = 0; v < dense.size(); ++v) {
      if (barred[v] != 0) continue;
      std::int64_t gain = dense.weight(v);
      for (std::size_t u = 0; u < dense.size(); ++u)
        if (chosen[u] != 0 && dense.has_edge(u, v)) gain -= dense.weight(u);
      ASSERT_EQ(gains->gain(v), gain);
      expected = std::max(expected.value_or(gain), gain);
    }
    ASSERT_EQ(greatest, expected);
    if (!greatest) continue;
    const std::size_t v = gains->greatest(random);
    ASSERT_LT(v, dense.size());
    EXPECT_EQ(barred[v], 0);
    EXPECT_EQ(gains->gain(v), *greatest);
  }
}

TEST(PushGains, AreThoseOfTheSetInNarrowAndInWideNumbers) {
  Random random(1);
  for (const std::int32_t vertices : {1, 2, 15, 16, 63, 64, 65, 200})
    for (const std::int64_t heaviest : {std::int64_t{3}, std::int64_t{200}, std::int64_t{1} << 40}) {
      ConflictGraph graph = hexpipe::testing::random_graph(vertices, 0.3, heaviest, random);
      ASSERT_NO_FATAL_FAILURE(check_gains(graph, random)) << vertices << " vertices up to " << heaviest;
    }
}

TEST(PushGains, TheGreatestIsAnyOfEqualOnes) {
  Random random(2);
  const mwis::ground::DenseGraph graph =
      mwis::ground::dense_graph_of(make_graph(std::vector<std::int64_t>(130, 5), {}));
  const auto gains = PushGains::make(graph);
  EXPECT_EQ(gains->settle(), 5);
  std::set<std::size_t> found;
  for (int i = 0; i < 5000; ++i) found.insert(gains->greatest(random));
  EXPECT_EQ(found.size(), 130U);
}

TEST(PushGains, SuitGraphsWithRoomForMarks) {
  const std::int64_t most = std::int64_t{1} << 60;
  EXPECT_TRUE(PushGains::suit(make_graph({most / 2, most / 2}, {{0, 1}})));
  EXPECT_FALSE(PushGains::suit(make_graph({most / 2, most / 2 + 1}, {{0, 1}})));
  EXPECT_FALSE(PushGains::suit(make_graph(std::vector<std::int64_t>(20000, 1), {})));
}

TEST(PushTabu, StaysConsistent) {
  Random random(3);
  for (int i = 0; i < 30; ++i) {
    const ConflictGraph graph =
        hexpipe::testing::random_graph(90, 0.2, i % 2 == 0 ? 50 : std::int64_t{1} << 40, random);
    PushTabu search(graph, Random(i));
    for (int round = 0; round < 20; ++round) {
      search.run(100, no_deadline);
      ASSERT_NO_FATAL_FAILURE(hexpipe::testing::check_consistency(search, graph));
    }
    EXPECT_EQ(search.moves(), 20 * 100);
  }
}

TEST(PushTabu, FindsTheOptimumOfSmallGraphs) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(22, 0.25, 50, random);
    PushTabu search(graph, Random(i));
    search.run(2000, no_deadline);
    EXPECT_EQ(search.best_weight(), hexpipe::testing::brute_force_weight(graph)) << "graph " << i;
  }
}

TEST(PushTabu, TakesTheExtremes) {
  for (const ConflictGraph& graph : {ConflictGraph{}, make_graph({3}, {}), make_graph({0, 4}, {})}) {
    PushTabu search(graph, Random(1));
    search.run(100, no_deadline);
    EXPECT_EQ(search.best_weight(), total_weight(search.best(), graph));
    EXPECT_EQ(search.best_weight(), graph.weights.empty() ? 0 : graph.weights.back());
  }
}

// Sets are matchings of 32 points (johnson32-2-4), or of a graph at random. In the first, a vertex that comes back soon
// undoes what the search did.
TEST(PushTabu, LearnsHowLongAVertexStaysOut) {
  Random random(5);
  constexpr std::int32_t points = 32;
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs, conflicts;
  for (std::int32_t a = 0; a < points; ++a)
    for (std::int32_t b = a + 1; b < points; ++b) pairs.emplace_back(a, b);
  const auto count = static_cast<std::int32_t>(pairs.size());
  for (std::int32_t i = 0; i < count; ++i)
    for (std::int32_t j = i + 1; j < count; ++j) {
      const auto [a, b] = pairs[i];
      const auto [c, d] = pairs[j];
      if (a == c || a == d || b == c || b == d) conflicts.emplace_back(i, j);
    }
  const ConflictGraph of_matchings = make_graph(hexpipe::testing::random_weights(count, 200, random), conflicts);
  const ConflictGraph at_random = hexpipe::testing::random_graph(600, 0.1, 200, random);
  PushTabu long_ones(of_matchings, Random(1)), short_ones(at_random, Random(1));
  long_ones.run(1'000'000, no_deadline);
  short_ones.run(1'000'000, no_deadline);
  EXPECT_GT(long_ones.usual_tenure(), short_ones.usual_tenure());
}

TEST(PushTabu, StopsAtItsDeadline) {
  Random random(6);
  const ConflictGraph graph = hexpipe::testing::random_graph(100, 0.1, 200, random);
  PushTabu search(graph, Random(1));
  search.run(std::int64_t{1} << 60, Deadline(0.02));
  EXPECT_GT(search.moves(), 0);
}

}  // namespace
}  // namespace hexpipe
