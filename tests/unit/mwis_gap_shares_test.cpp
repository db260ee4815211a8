#include "common/mwis/bounds/gap_shares.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "common/mwis/ground/solution_state.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace graph;
using namespace mwis::bounds;
using namespace mwis::ground;
namespace {

using hexpipe::testing::no_deadline;

IndependentSet maximal_set(const ConflictGraph& graph) {
  SolutionState state(graph, {});
  state.make_maximal();
  return state.to_set();
}

TEST(GapShares, AddUpToTheGapOfAMaximalSolution) {
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const auto vertices = 1 + static_cast<std::int32_t>(random.below(40));
    const ConflictGraph graph = hexpipe::testing::random_clique_graph(vertices, 30, 1000, random);
    const IndependentSet solution = maximal_set(graph);
    CliqueCover cover = greedy_edge_clique_cover(graph);
    const CliqueDual dual = solve_clique_dual(graph, cover, {.passes = 3}, no_deadline);
    const auto shares = gap_shares(graph, cover, dual.prices, solution);
    ASSERT_EQ(shares.size(), solution.size());
    for (const std::int64_t share : shares) EXPECT_GE(share, 0);
    EXPECT_EQ(std::accumulate(shares.begin(), shares.end(), std::int64_t{0}),
              dual.bound - total_weight(solution, graph))
        << "graph " << i;
  }
}

// Two stars of three rays, one of which has the wrong side chosen; both relaxations are tight.
TEST(GapShares, LieWhereTheSolutionIsNotTheBest) {
  const ConflictGraph graph =
      hexpipe::testing::make_graph({5, 2, 2, 2, 5, 2, 2, 2}, {{0, 1}, {0, 2}, {0, 3}, {4, 5}, {4, 6}, {4, 7}});
  const IndependentSet solution{0, 5, 6, 7};
  CliqueCover cover = greedy_edge_clique_cover(graph);
  const CliqueDual dual = solve_clique_dual(graph, cover, {}, no_deadline);
  EXPECT_EQ(dual.bound, 12);
  EXPECT_EQ(gap_shares(graph, cover, dual.prices, solution), (std::vector<std::int64_t>{1, 0, 0, 0}));
}

TEST(HoldsMostOfGap, IsTheFewestThatHoldFourFifths) {
  const IndependentSet solution{1, 3, 4, 6};
  EXPECT_EQ(holds_most_of_gap(8, solution, std::vector<std::int64_t>{1, 60, 9, 30}),
            (std::vector<bool>{false, false, false, true, false, false, true, false}));
  EXPECT_EQ(holds_most_of_gap(8, solution, std::vector<std::int64_t>(4, 0)), std::vector<bool>(8, false));
}

}  // namespace
}  // namespace hexpipe
