#include "common/mwis/local_search/annealing.hpp"

#include <gtest/gtest.h>

#include "random_graphs.hpp"

namespace hexpipe {
using namespace graph;
using namespace mwis::local_search;
namespace {

using hexpipe::testing::make_graph;
using hexpipe::testing::no_deadline;

TEST(Annealing, StaysConsistentAtEveryTemperature) {
  Random random(1);
  for (const double temperature : {1e-9, 3.0, 1000.0})
    for (int i = 0; i < 30; ++i) {
      const ConflictGraph graph = hexpipe::testing::random_graph(40, 0.2, 50, random);
      Annealing search(graph, {}, Random(i));
      std::int64_t best = search.best_weight();
      for (int round = 0; round < 20; ++round) {
        search.run(17, temperature, no_deadline);
        ASSERT_NO_FATAL_FAILURE(hexpipe::testing::check_consistency(search, graph));
        EXPECT_GE(search.best_weight(), best);
        best = search.best_weight();
      }
      EXPECT_EQ(search.kicks(), 20 * 17);
    }
}

TEST(Annealing, FindsTheOptimumOfSmallGraphs) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const ConflictGraph graph = i % 2 == 0 ? hexpipe::testing::random_graph(22, 0.25, 50, random)
                                           : hexpipe::testing::random_clique_graph(22, 40, 50, random);
    Annealing search(graph, {}, Random(i));
    const Cooling cooling;
    for (int step = 0; step < 20; ++step) search.run(50, search.mean_weight() * cooling.at(step / 20.0), no_deadline);
    EXPECT_EQ(search.best_weight(), hexpipe::testing::brute_force_weight(graph)) << "graph " << i;
  }
}

TEST(Annealing, ReachesEveryPartOfALargeGraph) {
  // Paths of five with the second and the fourth chosen: no move gains before one of the others was kicked in.
  constexpr std::int32_t paths = 53000;
  ConflictGraph graph;
  IndependentSet start;
  for (std::int32_t first = 0; first < 5 * paths; first += 5) {
    for (std::int32_t i = 0; i < 5; ++i) {
      if (i > 0) graph.neighbours.push_back(first + i - 1);
      if (i < 4) graph.neighbours.push_back(first + i + 1);
      graph.offsets.push_back(static_cast<std::int64_t>(graph.neighbours.size()));
      graph.weights.push_back(i % 2 == 0 ? 4 : 5);
    }
    start.insert(start.end(), {first + 1, first + 3});
  }
  Annealing search(graph, start, Random(1));
  EXPECT_EQ(search.best_weight(), 10 * paths);
  search.run(10 * paths, 1e-9, no_deadline);
  EXPECT_GT(search.best_weight(), std::int64_t{12} * paths * 99 / 100);
  EXPECT_TRUE(search.check());
}

TEST(Annealing, SwapsOneForTwo) {
  // No single vertex gains beside the middle one, the two ends together do.
  const ConflictGraph path = make_graph({3, 4, 3}, {{0, 1}, {1, 2}});
  EXPECT_EQ(Annealing(path, {1}, Random(1)).best(), (IndependentSet{0, 2}));
  // Three loose ends, of which the heaviest two are neighbours.
  const ConflictGraph fork = make_graph({9, 6, 6, 4}, {{0, 1}, {0, 2}, {0, 3}, {1, 2}});
  EXPECT_EQ(Annealing(fork, {0}, Random(1)).best_weight(), 10);
}

TEST(Annealing, CoolsGeometrically) {
  const Cooling cooling{.hot = 4, .cold = 0.25};
  EXPECT_DOUBLE_EQ(cooling.at(0), 4);
  EXPECT_DOUBLE_EQ(cooling.at(0.5), 1);
  EXPECT_DOUBLE_EQ(cooling.at(1), 0.25);
}

TEST(Annealing, TakesTheExtremes) {
  for (const ConflictGraph& graph : {ConflictGraph{}, make_graph({3}, {}), make_graph({3, 4}, {})}) {
    Annealing search(graph, {}, Random(1));
    search.run(100, 1, no_deadline);
    EXPECT_EQ(search.best().size(), graph.weights.size());
  }
  EXPECT_EQ(Annealing(make_graph({0}, {}), {}, Random(1)).mean_weight(), 1);
  const std::int64_t huge = std::int64_t{1} << 60;
  const ConflictGraph heavy = make_graph({huge, huge + 1, huge}, {{0, 1}, {1, 2}});
  Annealing search(heavy, {1}, Random(1));
  search.run(100, 1, no_deadline);
  EXPECT_EQ(search.best_weight(), 2 * huge);
}

}  // namespace
}  // namespace hexpipe
