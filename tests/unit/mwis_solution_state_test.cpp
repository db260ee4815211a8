#include "common/mwis/ground/solution_state.hpp"

#include <gtest/gtest.h>

#include "random_graphs.hpp"

namespace hexpipe {
using namespace graph;
using namespace mwis::ground;
namespace {

TEST(SolutionState, StaysConsistentUnderRandomMoves) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(30, 0.2, 100, random);
    SolutionState state(graph);
    for (int move = 0; move < 100; ++move) {
      const auto v = static_cast<std::int32_t>(random.below(30));
      if (state.contains(v))
        state.remove(v);
      else if (state.tightness(v) == 0)
        state.add(v);
    }
    ASSERT_TRUE(state.check()) << "graph " << i;
    ASSERT_NO_THROW(validate(state.to_set(), graph, "state"));
    EXPECT_EQ(state.weight(), total_weight(state.to_set(), graph));
    for (std::int32_t v = 0; v < 30; ++v) {
      std::int32_t tightness = 0;
      std::int64_t weight = 0;
      state.for_each_chosen_neighbour(v, [&](std::int32_t u) {
        EXPECT_TRUE(state.contains(u) && graph.has_edge(u, v));
        ++tightness;
        weight += graph.weights[u];
      });
      EXPECT_EQ(tightness, state.tightness(v));
      EXPECT_EQ(state.push_gain(v), graph.weights[v] - weight);
    }
    state.make_maximal();
    ASSERT_TRUE(state.check());
    for (std::int32_t v = 0; v < 30; ++v) EXPECT_TRUE(state.contains(v) || state.tightness(v) > 0);
  }
}

TEST(SolutionState, MakesMaximalWithZeroWeightsAndTheHeaviestFirst) {
  const ConflictGraph graph = hexpipe::testing::make_graph({0, 3, 5, 4}, {{1, 2}, {2, 3}});
  SolutionState state(graph);
  state.make_maximal();
  EXPECT_EQ(state.to_set(), (IndependentSet{0, 2}));
}

TEST(SolutionState, TakesASet) {
  const ConflictGraph graph = hexpipe::testing::make_graph({1, 3, 5, 4}, {{1, 2}, {2, 3}});
  const SolutionState state(graph, {1, 3});
  EXPECT_TRUE(state.check());
  EXPECT_EQ(state.weight(), 7);
  EXPECT_EQ(state.tightness(2), 2);
  EXPECT_EQ(state.neighbour_sum(2), 4u);
}

}  // namespace
}  // namespace hexpipe
