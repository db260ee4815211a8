#include "common/mwis/local_search/remainder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

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

// In rows, so that a sample of near vertices has whole neighbourhoods: each vertex is in conflict with `each` of the
// `within` vertices on either side of it.
ConflictGraph long_row(std::int32_t vertices, std::int32_t each, std::int32_t within, Random& random) {
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::int32_t v = 0; v < vertices; ++v)
    for (std::int32_t i = 0; i < each; ++i) {
      const std::int32_t u = v + 1 + (each == within ? i : static_cast<std::int32_t>(random.below(within)));
      if (u < vertices) edges.emplace_back(v, u);
    }
  return hexpipe::testing::make_graph(hexpipe::testing::random_weights(vertices, 1000, random), edges);
}

// Reductions decide nearly all of an interval graph, and nearly nothing of a random one.
TEST(Remainder, LeavesALargeGraphAsItIsWhereASampleIsHardlyReduced) {
  Random random(4);
  const ConflictGraph hard = long_row(70000, 12, 60, random);
  const Remainder whole(hard, no_deadline);
  EXPECT_EQ(&whole.graph(), &hard) << "not even copied";
  EXPECT_EQ(whole.offset(), 0);
  const IndependentSet some{3, 5000, 69999};
  EXPECT_EQ(whole.project(some), some);
  EXPECT_EQ(whole.originals(some), some);
  const IndependentSet lifted = whole.lift(some);
  EXPECT_NO_THROW(validate(lifted, hard, "lifted"));
  EXPECT_GT(lifted.size(), some.size()) << "made maximal";

  const ConflictGraph easy = long_row(70000, 10, 10, random);
  const Remainder rest(easy, no_deadline);
  EXPECT_LT(rest.graph().vertex_count(), 7000);
  EXPECT_NO_THROW(validate(rest.lift({}), easy, "lifted"));

  // A small one is reduced as far as it goes.
  const ConflictGraph small = long_row(20000, 12, 60, random);
  EXPECT_NE(&Remainder(small, no_deadline).graph(), &small);
}

TEST(Components, AreAsOneFindsThemByWalking) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const auto count = static_cast<std::int32_t>(random.below(60));
    const ConflictGraph graph = hexpipe::testing::random_graph(count, 0.03, 10, random);
    std::vector<std::vector<std::int32_t>> expected;
    std::vector<char> seen(graph.weights.size(), 0);
    for (std::int32_t first = 0; first < count; ++first) {
      if (seen[first] != 0) continue;
      seen[first] = 1;
      std::vector<std::int32_t>& component = expected.emplace_back(1, first);
      for (std::size_t next = 0; next < component.size(); ++next)
        for (const std::int32_t u : graph.neighbours_of(component[next]))
          if (seen[u] == 0) seen[u] = 1, component.push_back(u);
      std::ranges::sort(component);
    }
    std::ranges::stable_sort(expected, {}, [](const auto& component) { return component.size(); });
    EXPECT_EQ(connected_components(graph), expected) << "graph " << i;
  }
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
