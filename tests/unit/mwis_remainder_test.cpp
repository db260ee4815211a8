#include "common/mwis/local_search/remainder.hpp"

#include <gtest/gtest.h>

#include "common/mwis/ground/solution_state.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace mwis;
using namespace graph;
using namespace mwis::local_search;
namespace {

using hexpipe::testing::brute_force_weight;
using hexpipe::testing::no_deadline;

TEST(Remainder, SolvesSmallGraphs) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const auto count = static_cast<std::int32_t>(random.below(22));
    const ConflictGraph graph = i % 2 == 0 ? hexpipe::testing::random_graph(count, random.uniform(), 100, random)
                                           : hexpipe::testing::random_clique_graph(count, 20, 3, random);
    const Remainder rest(graph, no_deadline);
    ASSERT_TRUE(rest.is_solved()) << "graph " << i;
    const IndependentSet set = rest.lift({});
    ASSERT_NO_THROW(validate(set, graph, "lifted")) << "graph " << i;
    EXPECT_EQ(total_weight(set, graph), brute_force_weight(graph)) << "graph " << i;
    EXPECT_EQ(rest.offset(), total_weight(set, graph)) << "graph " << i;
  }
}

// Copies of a graph beside one that is too large to solve: only that one is left.
TEST(Remainder, LeavesWhatItCannotSolve) {
  Random random(2);
  const ConflictGraph large = hexpipe::testing::random_graph(700, 0.1, 1000, random);
  const ConflictGraph small = hexpipe::testing::random_graph(18, 0.3, 1000, random);
  ConflictGraph both = large;
  for (std::int32_t v = 0; v < small.vertex_count(); ++v) {
    for (const std::int32_t u : small.neighbours_of(v)) both.neighbours.push_back(u + 700);
    both.offsets.push_back(static_cast<std::int64_t>(both.neighbours.size()));
    both.weights.push_back(small.weights[v]);
  }
  const Remainder rest(both, no_deadline);
  ASSERT_FALSE(rest.is_solved());
  EXPECT_LE(rest.graph().vertex_count(), 700);
  EXPECT_NO_THROW(validate(rest.graph(), "remainder"));

  ground::SolutionState state(both);
  state.make_maximal();
  const IndependentSet projected = rest.project(state.to_set());
  EXPECT_NO_THROW(validate(projected, rest.graph(), "projected"));
  const IndependentSet lifted = rest.lift(projected);
  EXPECT_NO_THROW(validate(lifted, both, "lifted"));
  EXPECT_GE(total_weight(lifted, both), total_weight(projected, rest.graph()) + rest.offset());
  std::int64_t of_small = 0;
  for (const std::int32_t v : lifted) of_small += v >= 700 ? both.weights[v] : 0;
  EXPECT_EQ(of_small, brute_force_weight(small));
  for (const std::int32_t v : rest.originals(projected)) EXPECT_LT(v, 700);
}

TEST(Remainder, KeepsItsShareOfTheTime) {
  Random random(3);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(3000, 900, 1000, random);
  const Remainder rest(graph, Deadline(0));
  EXPECT_FALSE(rest.is_solved());
  EXPECT_NO_THROW(validate(rest.lift({}), graph, "lifted"));
}

}  // namespace
}  // namespace hexpipe
