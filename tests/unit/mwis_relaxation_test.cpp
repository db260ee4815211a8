#include "common/mwis/bounds/relaxation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/mwis/bounds/clique_dual.hpp"
#include "common/mwis/exact/heavy_cliques.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace graph;
using namespace mwis::bounds;
using namespace mwis::exact;
namespace {

using hexpipe::testing::brute_force_weight;
using hexpipe::testing::make_graph;

ConflictGraph small_graph(int i, Random& random) {
  const auto vertices = static_cast<std::int32_t>(1 + random.below(18));
  return i % 2 == 0 ? hexpipe::testing::random_graph(vertices, random.uniform(), 1000, random)
                    : hexpipe::testing::random_clique_graph(vertices, 20, 1000, random);
}

// The heaviest set with v, or without it.
std::int64_t optimum_given(const ConflictGraph& graph, std::int32_t v, bool chosen) {
  ConflictGraph rest = graph;
  rest.weights[v] = 0;
  if (chosen)
    for (const std::int32_t u : graph.neighbours_of(v)) rest.weights[u] = 0;
  return brute_force_weight(rest) + (chosen ? graph.weights[v] : 0);
}

TEST(Relaxation, AnyPricesProveItsBounds) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const ConflictGraph graph = small_graph(i, random);
    const CliqueCover cover = greedy_edge_clique_cover(graph);
    std::vector<double> prices(static_cast<std::size_t>(cover.size()));
    for (double& price : prices) price = random.uniform(0, 300);
    const Relaxation relaxation = bounds_of_prices(graph, cover, prices);
    EXPECT_GE(relaxation.bound, brute_force_weight(graph)) << "graph " << i;
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
      EXPECT_GE(relaxation.with[v], optimum_given(graph, v, true)) << "graph " << i << ", vertex " << v;
      EXPECT_GE(relaxation.without[v], optimum_given(graph, v, false)) << "graph " << i << ", vertex " << v;
    }
  }
}

TEST(Relaxation, IsExactInWholeNumbersAndTakesFractions) {
  const ConflictGraph graph = make_graph({5, 7, 9}, {{0, 1}, {1, 2}, {0, 2}});
  const CliqueCover cover = greedy_edge_clique_cover(graph);
  EXPECT_EQ(bounds_of_prices(graph, cover, {9}).bound, 9);
  EXPECT_EQ(bounds_of_prices(graph, cover, {8.25}).bound, 9);
  EXPECT_EQ(bounds_of_prices(graph, cover, {9.5}).bound, 9);
  EXPECT_EQ(bounds_of_prices(graph, cover, {9}).with[0], 5);
  // A pentagon, whose fractional optimum is half of all.
  const ConflictGraph pentagon = make_graph({1, 1, 1, 1, 1}, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {0, 4}});
  EXPECT_EQ(bounds_of_prices(pentagon, greedy_edge_clique_cover(pentagon), {.5, .5, .5, .5, .5}).bound, 2);
}

TEST(Relaxation, TakesWeightsWithoutRoomForFractions) {
  const std::int64_t huge = std::int64_t{1} << 62;
  const ConflictGraph graph = make_graph({huge, huge - 1}, {{0, 1}});
  EXPECT_GE(bounds_of_prices(graph, greedy_edge_clique_cover(graph), {static_cast<double>(huge)}).bound, huge);
  const ConflictGraph less = make_graph({huge >> 4, huge >> 4}, {{0, 1}});
  EXPECT_GE(bounds_of_prices(less, greedy_edge_clique_cover(less), {1e300}).bound, huge >> 4);
  const auto price = static_cast<double>(huge >> 4);
  EXPECT_EQ(bounds_of_prices(less, greedy_edge_clique_cover(less), {price}).bound, huge >> 4);
}

// A sum of up to 2^63, of which four times would not fit 64 bits.
TEST(Relaxation, BoundsHugeWeightsAsWellAsOthers) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    ConflictGraph graph = small_graph(i, random);
    const CliqueCover cover = greedy_edge_clique_cover(graph);
    std::vector<double> prices(static_cast<std::size_t>(cover.size()));
    for (double& price : prices) price = random.uniform(0, 300);
    const Relaxation relaxation = bounds_of_prices(graph, cover, prices);
    // At most 18 * 1000 before.
    constexpr int factor_bits = 48;
    for (std::int64_t& weight : graph.weights) weight <<= factor_bits;
    for (double& price : prices) price = std::ldexp(price, factor_bits);
    const Relaxation huge = bounds_of_prices(graph, cover, prices);
    EXPECT_EQ(huge.bound >> factor_bits, relaxation.bound) << "graph " << i;
    EXPECT_GE(huge.bound, brute_force_weight(graph)) << "graph " << i;
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
      EXPECT_EQ(huge.with[v] >> factor_bits, relaxation.with[v]) << "graph " << i << ", vertex " << v;
      EXPECT_EQ(huge.without[v] >> factor_bits, relaxation.without[v]) << "graph " << i << ", vertex " << v;
    }
  }
}

// A price that pays for more than its clique weighs brings a bound that fits no 64 bits.
TEST(Relaxation, IsNeverAboveAllWeightsTogether) {
  const std::int64_t unit = std::int64_t{1} << 61;
  const ConflictGraph graph = make_graph({unit, 3 * unit - 1}, {});
  CliqueCover cover;
  cover.add({0});
  const Relaxation relaxation = bounds_of_prices(graph, cover, {std::ldexp(1.0, 62)});
  EXPECT_EQ(relaxation.bound, 4 * (unit - 1) + 3);
  EXPECT_EQ(relaxation.with, (std::vector<std::int64_t>(2, relaxation.bound)));
  EXPECT_EQ(relaxation.without[0], relaxation.bound);
}

TEST(HeavyCliques, AreFoundExactlyWhereTheyExist) {
  Random random(2);
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const ConflictGraph graph = small_graph(i, random);
    std::vector<double> fractions(graph.weights.size());
    for (double& fraction : fractions) fraction = random.uniform(0, 0.6);
    // The heaviest clique is an independent set of the complement.
    ConflictGraph complement = hexpipe::testing::complement_of(graph);
    for (std::size_t v = 0; v < fractions.size(); ++v) complement.weights[v] = std::llround(1e6 * fractions[v]);
    const std::int64_t heaviest = brute_force_weight(complement);
    CliqueCover cover;
    HeavyCliques search(graph);
    const std::int64_t added = search.add(fractions, cover);
    EXPECT_EQ(added, cover.size());
    EXPECT_TRUE(added > 0 || heaviest < 1'020'000) << "graph " << i;
    EXPECT_TRUE(added == 0 || heaviest > 1'000'000) << "graph " << i;
    found += added > 0 ? 1 : 0;
    for (std::int64_t c = 0; c < cover.size(); ++c) {
      double sum = 0;
      for (const std::int32_t v : cover.clique(c)) {
        sum += fractions[v];
        for (const std::int32_t u : cover.clique(c)) EXPECT_TRUE(u == v || graph.has_edge(u, v)) << "graph " << i;
      }
      EXPECT_GT(sum, 1) << "graph " << i;
    }
  }
  EXPECT_GT(found, 50);
}

}  // namespace
}  // namespace hexpipe
