#include "common/mwis/local_search/recombination.hpp"

#include <gtest/gtest.h>

#include <iterator>

#include "common/mwis/ground/solution_state.hpp"
#include "random_graphs.hpp"
#include "tests/unit/random_cases.hpp"

namespace hexpipe {
using namespace graph;
using namespace mwis::ground;
using namespace mwis::local_search;
namespace {

using hexpipe::testing::make_graph;

IndependentSet random_set(const ConflictGraph& graph, Random& random) {
  SolutionState state(graph);
  for (int i = 0; i < 3 * graph.vertex_count(); ++i) {
    const auto v = static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(graph.vertex_count())));
    if (!state.contains(v) && state.tightness(v) == 0) state.add(v);
  }
  return state.to_set();
}

// The heaviest set that takes its vertices from a and b, by trying everything.
std::int64_t best_of_both(const ConflictGraph& graph, const IndependentSet& a, const IndependentSet& b) {
  std::uint64_t outside = ~std::uint64_t{0};
  for (const IndependentSet& set : {a, b})
    for (const std::int32_t v : set) outside &= ~(std::uint64_t{1} << v);
  return hexpipe::testing::brute_force_weight(graph, 0, outside);
}

TEST(Recombination, FindsTheHeaviestOfBoth) {
  Random random(1);
  int better_than_both = 0;
  constexpr int graphs = hexpipe::testing::random_cases(2000);
  for (int i = 0; i < graphs; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(24, random.uniform(0.05, 0.3), 20, random);
    const IndependentSet a = random_set(graph, random), b = random_set(graph, random);
    const IndependentSet both = recombine(graph, a, b);
    ASSERT_NO_THROW(validate(both, graph, "recombined"));
    ASSERT_EQ(total_weight(both, graph), best_of_both(graph, a, b));
    better_than_both += total_weight(both, graph) > std::max(total_weight(a, graph), total_weight(b, graph));
  }
  EXPECT_GT(better_than_both, graphs / 4);
}

TEST(Recombination, TakesTheBetterOfEachComponent) {
  const ConflictGraph graph = make_graph({5, 3, 4, 9}, {{0, 1}, {2, 3}});
  EXPECT_EQ(recombine(graph, {0, 2}, {1, 3}), (IndependentSet{0, 3}));
  EXPECT_EQ(recombine(graph, {1, 3}, {0, 2}), (IndependentSet{0, 3}));
}

TEST(Recombination, CutsAComponent) {
  // A path 0 - 1 - 2 - 3 - 4: neither side, but the beginning of one and the end of the other.
  const ConflictGraph path = make_graph({9, 1, 2, 8, 1}, {{0, 1}, {1, 2}, {2, 3}, {3, 4}});
  EXPECT_EQ(recombine(path, {0, 2, 4}, {1, 3}), (IndependentSet{0, 3}));
}

TEST(Recombination, TakesTheSecondWhereBothWeighTheSame) {
  const ConflictGraph graph = make_graph({5, 5}, {{0, 1}});
  EXPECT_EQ(recombine(graph, {0}, {1}), (IndependentSet{1}));
  EXPECT_EQ(recombine(graph, {1}, {0}), (IndependentSet{0}));
}

TEST(Recombination, TakesTheExtremes) {
  const ConflictGraph graph = make_graph({0, std::int64_t{1} << 62}, {{0, 1}});
  EXPECT_EQ(recombine(graph, {}, {}), IndependentSet{});
  EXPECT_EQ(recombine(graph, {1}, {}), (IndependentSet{1}));
  EXPECT_EQ(recombine(graph, {}, {1}), (IndependentSet{1}));
  EXPECT_EQ(recombine(graph, {0}, {1}), (IndependentSet{1}));
  EXPECT_EQ(recombine(graph, {1}, {1}), (IndependentSet{1}));
}

}  // namespace
}  // namespace hexpipe
