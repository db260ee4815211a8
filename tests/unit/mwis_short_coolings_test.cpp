#include "common/mwis/local_search/short_coolings.hpp"

#include <gtest/gtest.h>

#include "random_graphs.hpp"

namespace hexpipe {
using namespace graph;
using namespace mwis::local_search;
namespace {

using hexpipe::testing::make_graph;
using hexpipe::testing::no_deadline;

TEST(PushWalk, StaysConsistentAtEveryTemperature) {
  Random random(1);
  for (const double temperature : {1e-9, 3.0, 1000.0})
    for (int i = 0; i < 30; ++i) {
      const ConflictGraph graph = hexpipe::testing::random_graph(40, 0.2, 50, random);
      PushWalk walk(graph, {}, Random(i));
      std::int64_t heaviest = walk.best_weight();
      for (int round = 0; round < 20; ++round) {
        heaviest = std::max(heaviest, walk.run(100, temperature, no_deadline));
        ASSERT_NO_FATAL_FAILURE(hexpipe::testing::check_consistency(walk, graph));
        EXPECT_EQ(walk.best_weight(), heaviest);
      }
      EXPECT_EQ(walk.trials(), 20 * 100);
    }
}

TEST(PushWalk, LosesOnlyWhenItIsHot) {
  // One for the middle of three: a loss of 1.
  const ConflictGraph path = make_graph({2, 3, 2}, {{0, 1}, {1, 2}});
  PushWalk cold(path, {0, 2}, Random(1)), hot(path, {0, 2}, Random(1));
  EXPECT_EQ(cold.run(1000, 0.01, no_deadline), 4);
  EXPECT_EQ(cold.touched(), 0);
  EXPECT_EQ(hot.run(1000, 1, no_deadline), 4);
  EXPECT_GT(hot.touched(), 100);
}

TEST(PushWalk, TakesTheExtremes) {
  for (const ConflictGraph& graph : {ConflictGraph{}, make_graph({3}, {}), make_graph({0, 4}, {})}) {
    PushWalk walk(graph, {}, Random(1));
    walk.run(100, 1, no_deadline);
    EXPECT_EQ(walk.best().size(), graph.weights.size());
  }
  const std::int64_t huge = std::int64_t{1} << 60;
  const ConflictGraph heavy = make_graph({huge, huge + 1, huge}, {{0, 1}, {1, 2}});
  PushWalk walk(heavy, {1}, Random(1));
  walk.run(1000, static_cast<double>(huge), no_deadline);
  EXPECT_EQ(walk.best_weight(), 2 * huge);
}

TEST(ShortCoolings, FindTheOptimumOfSmallGraphs) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(22, 0.25, 50, random);
    ShortCoolings search(graph, {}, Random(i));
    search.run(200000, no_deadline);
    EXPECT_EQ(search.best_weight(), hexpipe::testing::brute_force_weight(graph)) << "graph " << i;
  }
}

TEST(ShortCoolings, SuitDenseGraphsWithFewChosen) {
  Random random(3);
  const ConflictGraph dense = hexpipe::testing::random_graph(300, 0.1, 200, random);
  EXPECT_TRUE(ShortCoolings::suit(dense, 40));
  EXPECT_FALSE(ShortCoolings::suit(dense, 251));
  EXPECT_FALSE(ShortCoolings::suit(hexpipe::testing::random_graph(300, 0.01, 200, random), 40));
  EXPECT_FALSE(ShortCoolings::suit(hexpipe::testing::random_graph(50, 0.5, 200, random), 8));
}

TEST(ShortCoolings, GoOnWhereTheLastCallEnded) {
  Random random(4);
  const ConflictGraph graph = hexpipe::testing::random_graph(100, 0.1, 200, random);
  ShortCoolings at_once(graph, {}, Random(1)), in_parts(graph, {}, Random(1));
  at_once.run(3e6, no_deadline);
  for (int i = 0; i < 1000; ++i) in_parts.run(3e3, no_deadline);
  EXPECT_EQ(in_parts.best(), at_once.best());
  EXPECT_EQ(in_parts.coolings(), at_once.coolings());
  EXPECT_EQ(in_parts.touched(), at_once.touched());
}

// 1000 draws a vertex for the first cooling; then once, twice, once, once, twice and four times as many, but each time
// a thirty-second more.
TEST(ShortCoolings, AreOfDifferentLengths) {
  Random random(5);
  const ConflictGraph graph = hexpipe::testing::random_graph(100, 0.1, 200, random);
  ShortCoolings search(graph, {}, Random(1));
  search.run(1, no_deadline);
  ASSERT_EQ(search.coolings(), 1);
  std::int64_t begin = 0;
  for (const int times : {1, 1, 2, 1, 1, 2, 4}) {
    const std::int64_t cooling = search.coolings();
    while (search.coolings() == cooling) search.run(1e4, no_deadline);
    const double drawn = static_cast<double>(search.trials() - begin);
    begin = search.trials();
    EXPECT_NEAR(drawn, 1e5 * times * (1 + static_cast<double>(cooling) / 32), 2e4) << "cooling " << cooling;
  }
}

// In other units of weight the same happens.
TEST(ShortCoolings, LearnTheirTemperatureFromTheGraph) {
  Random random(6);
  ConflictGraph graph = hexpipe::testing::random_graph(200, 0.1, 200, random);
  ShortCoolings search(graph, {}, Random(1));
  const double first = search.usual_temperature();
  search.run(2e7, no_deadline);
  EXPECT_NE(search.usual_temperature(), first);
  const std::int64_t weight = search.best_weight();
  for (std::int64_t& each : graph.weights) each *= 1024;
  ShortCoolings in_other_units(graph, {}, Random(1));
  in_other_units.run(2e7, no_deadline);
  EXPECT_DOUBLE_EQ(in_other_units.usual_temperature(), 1024 * search.usual_temperature());
  EXPECT_EQ(in_other_units.best_weight(), 1024 * weight);
}

TEST(ShortCoolings, StopAtTheirDeadline) {
  Random random(7);
  const ConflictGraph graph = hexpipe::testing::random_graph(100, 0.1, 200, random);
  ShortCoolings search(graph, {}, Random(1));
  search.run(1e18, Deadline(0.02));
  EXPECT_GT(search.coolings(), 0);
}

}  // namespace
}  // namespace hexpipe
