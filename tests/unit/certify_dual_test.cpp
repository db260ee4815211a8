#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "random_graphs.hpp"
#include "tools/certify/certify.hpp"

namespace hexpipe {
using namespace certify;
using namespace graph;
using namespace mwis::bounds;
namespace {

using hexpipe::testing::brute_force_weight;
using hexpipe::testing::make_graph;
using hexpipe::testing::no_deadline;

ConflictGraph nth_graph(int i, Random& random) {
  const auto vertices = static_cast<std::int32_t>(random.below(22));
  return i % 2 == 0 ? hexpipe::testing::random_graph(vertices, random.uniform(), 1000, random)
                    : hexpipe::testing::random_clique_graph(vertices, 30, 1000, random);
}

TEST(CliqueCover, HasCliquesOnlyAndEveryEdge) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const ConflictGraph graph = nth_graph(i, random);
    const CliqueCover cover = greedy_edge_clique_cover(graph);
    std::vector<std::vector<char>> together(graph.weights.size(), std::vector<char>(graph.weights.size(), 0));
    for (std::int64_t c = 0; c < cover.size(); ++c)
      for (const std::int32_t v : cover.clique(c))
        for (const std::int32_t u : cover.clique(c)) {
          EXPECT_TRUE(u == v || graph.has_edge(u, v)) << "graph " << i;
          together[u][v] = 1;
        }
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
      EXPECT_TRUE(together[v][v]) << "every vertex is in a clique, graph " << i;
      for (const std::int32_t u : graph.neighbours_of(v)) EXPECT_TRUE(together[u][v]) << "graph " << i;
    }
  }
}

TEST(CliqueCover, IsOneCliqueWhereTheGraphIs) {
  Random random(2);
  EXPECT_EQ(greedy_edge_clique_cover(hexpipe::testing::random_graph(20, 1.0, 5, random)).size(), 1);
  EXPECT_EQ(greedy_edge_clique_cover(make_graph({1, 2, 3}, {})).size(), 3);
  EXPECT_EQ(greedy_edge_clique_cover({}).size(), 0);
}

TEST(CliqueCover, GetsTheCliquesThatASolutionViolates) {
  Random random(8);
  const ConflictGraph complete = hexpipe::testing::random_graph(5, 1.0, 5, random);
  CliqueCover edges;
  for (std::int32_t a = 0; a < 5; ++a)
    for (std::int32_t b = a + 1; b < 5; ++b) edges.add({a, b});
  EXPECT_EQ(add_violated_cliques(complete, std::vector<double>(5, 0.2), edges), 0);
  EXPECT_GE(add_violated_cliques(complete, std::vector<double>(5, 0.5), edges), 1);
  EXPECT_EQ(edges.clique(10).size(), 5);
  for (int i = 0; i < 200; ++i) {
    const ConflictGraph graph = nth_graph(i, random);
    std::vector<double> fractions(graph.weights.size());
    for (double& fraction : fractions) fraction = random.uniform();
    CliqueCover cover;
    add_violated_cliques(graph, fractions, cover);
    for (std::int64_t c = 0; c < cover.size(); ++c) {
      double sum = 0;
      for (const std::int32_t v : cover.clique(c)) {
        sum += fractions[v];
        for (const std::int32_t u : cover.clique(c)) EXPECT_TRUE(u == v || graph.has_edge(u, v)) << "graph " << i;
      }
      EXPECT_GT(sum, 1) << "graph " << i;
    }
  }
}

// The relaxation of a graph of cliques that share no more than edges is looser without the cliques that were left out.
TEST(CliqueDual, AddsCliquesThatTheCoverMisses) {
  Random random(9);
  const ConflictGraph graph = hexpipe::testing::random_graph(12, 1.0, 1000, random);
  CliqueCover edges;
  for (std::int32_t a = 0; a < 12; ++a)
    for (std::int32_t b = a + 1; b < 12; ++b) edges.add({a, b});
  const std::int64_t heaviest = std::ranges::max(graph.weights);
  const CliqueDual dual = solve_clique_dual(graph, edges, {.passes = 300}, no_deadline);
  EXPECT_LT(static_cast<double>(dual.bound), 1.05 * static_cast<double>(heaviest));
  EXPECT_EQ(dual.bound, bound_of_prices(graph, edges, dual.prices));
}

TEST(CliqueDual, AnyPricesProveABound) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const ConflictGraph graph = nth_graph(i, random);
    const CliqueCover cover = greedy_edge_clique_cover(graph);
    std::vector<std::int64_t> prices(cover.size());
    for (auto& price : prices) price = static_cast<std::int64_t>(random.below(1000));
    EXPECT_GE(bound_of_prices(graph, cover, prices), brute_force_weight(graph)) << "graph " << i;
  }
}

TEST(CliqueDual, BoundsTheOptimumClosely) {
  Random random(4);
  std::int64_t bounds = 0, optima = 0;
  for (int i = 0; i < 300; ++i) {
    const ConflictGraph graph = nth_graph(i, random);
    CliqueCover cover = greedy_edge_clique_cover(graph);
    const CliqueDual dual = solve_clique_dual(graph, cover, {.passes = 200}, no_deadline);
    const std::int64_t optimum = brute_force_weight(graph);
    EXPECT_GE(dual.bound, optimum) << "graph " << i;
    EXPECT_EQ(dual.bound, bound_of_prices(graph, cover, dual.prices)) << "graph " << i;
    EXPECT_TRUE(std::ranges::all_of(dual.prices, [](std::int64_t price) { return price >= 0; }));
    bounds += dual.bound;
    optima += optimum;
  }
  EXPECT_LT(bounds, optima + optima / 50);
}

// Where the graph is perfect and the cliques are maximal, the relaxation is the optimum.
TEST(CliqueDual, IsNearlyTightOnTrees) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;
    for (std::int32_t v = 1; v < 22; ++v) edges.emplace_back(v, static_cast<std::int32_t>(random.below(v)));
    const ConflictGraph tree = make_graph(hexpipe::testing::random_weights(22, 1000000, random), edges);
    const std::int64_t optimum = brute_force_weight(tree);
    CliqueCover cover = greedy_edge_clique_cover(tree);
    const CliqueDual dual = solve_clique_dual(tree, cover, {.passes = 1000}, no_deadline);
    EXPECT_GE(dual.bound, optimum);
    EXPECT_LT(static_cast<double>(dual.bound), 1.01 * static_cast<double>(optimum));
  }
}

// Temperatures are those of the heaviest vertex, and the sum of all prices at first does not fit 64 bits.
TEST(CliqueDual, OneHeavyVertexAmongManyLightOnesOverflowsNoBound) {
  constexpr std::int32_t edges = 1000;
  for (const std::int64_t heaviest : {std::int64_t{1'000'000'000'000'000}, std::int64_t{4'000'000'000'000'000'000}}) {
    std::vector<std::int64_t> weights{heaviest};
    std::vector<std::pair<std::int32_t, std::int32_t>> ends;
    for (std::int32_t i = 0; i < edges; ++i) {
      weights.insert(weights.end(), {3, 5});
      ends.emplace_back(2 * i + 1, 2 * i + 2);
    }
    const ConflictGraph graph = make_graph(weights, ends);
    CliqueCover cover = greedy_edge_clique_cover(graph);
    const CliqueDual dual = solve_clique_dual(graph, cover, {.passes = 30}, no_deadline);
    EXPECT_EQ(dual.bound, heaviest + 5 * edges);
    EXPECT_EQ(dual.bound, bound_of_prices(graph, cover, dual.prices));
  }
}

TEST(CliqueDual, PricesWhoseSumOverflowsProveNothing) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  const ConflictGraph graph = make_graph({7, 8, 9}, {{0, 1}});
  CliqueCover cover;
  cover.add({0, 1});
  cover.add({2});
  EXPECT_EQ(bound_of_prices(graph, cover, {most, 1}), most);
  EXPECT_EQ(bound_of_prices(graph, cover, {most, most}), most);
  EXPECT_EQ(bound_of_prices(graph, cover, {most - 3, 3}), most) << "prices fit, what is left does not";
  EXPECT_EQ(bound_of_prices(graph, cover, {8, 9}), 17);
}

TEST(CliqueDual, MorePassesAndMoreTimeHelp) {
  Random random(6);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(500, 300, 100000, random);
  const auto bound = [&](std::int64_t passes) {
    CliqueCover cover = greedy_edge_clique_cover(graph);
    return solve_clique_dual(graph, cover, {.passes = passes}, no_deadline).bound;
  };
  EXPECT_EQ(bound(0), std::reduce(graph.weights.begin(), graph.weights.end(), std::int64_t{0}));
  EXPECT_LT(bound(10), bound(0));
  EXPECT_LT(bound(300), bound(10));
  CliqueCover cover;
  const CliqueDual none = solve_clique_dual(graph, cover, {}, Deadline(0));
  EXPECT_EQ(none.passes, 0);
}

TEST(Certify, ProvesOptimalityAndFixes) {
  // A clique and a vertex apart: the relaxation is exact.
  const ConflictGraph graph = make_graph({500, 700, 900, 4}, {{0, 1}, {1, 2}, {0, 2}});
  const CertifyResult best = certify::certify(graph, {2, 3}, {}, {}, no_deadline);
  EXPECT_EQ(best.weight, 904);
  EXPECT_TRUE(best.maximal);
  EXPECT_EQ(best.dual.bound, 904);
  EXPECT_TRUE(best.complete);
  EXPECT_EQ(best.gap, 0);
  const CertifyResult worse = certify::certify(graph, {1}, {}, {}, no_deadline);
  EXPECT_FALSE(worse.maximal);
  EXPECT_FALSE(worse.complete);
  EXPECT_NEAR(worse.gap, 204.0 / 904.0, 0.01);
  EXPECT_GE(best.fixed_out, worse.fixed_out);
  EXPECT_GT(best.fixed_out, 0);
}

TEST(Certify, FixesOnlyWhatNoBetterSolutionHas) {
  Random random(7);
  std::int64_t fixed = 0;
  for (int i = 0; i < 200; ++i) {
    const ConflictGraph graph = nth_graph(i, random);
    CliqueCover cover = greedy_edge_clique_cover(graph);
    const CliqueDual dual = solve_clique_dual(graph, cover, {.passes = 100}, no_deadline);
    const std::int64_t optimum = brute_force_weight(graph);
    const auto costs = reduced_costs(graph, cover, dual.prices);
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
      if (-costs[v] <= dual.bound - optimum) continue;
      ++fixed;
      // With v alone and its neighbours gone, nothing reaches the optimum.
      ConflictGraph with = graph;
      for (const std::int32_t u : graph.neighbours_of(v)) with.weights[u] = 0;
      EXPECT_LT(brute_force_weight(with), optimum) << "graph " << i;
    }
  }
  EXPECT_GT(fixed, 100);
}

TEST(Certify, PricesTheCliquesThatAreKnown) {
  const ConflictGraph graph = make_graph({500, 700, 900, 4}, {{0, 1}, {1, 2}, {0, 2}});
  CliqueCover edges, tet;
  for (const std::vector<std::int32_t>& edge : {std::vector<std::int32_t>{0, 1}, {0, 2}, {1, 2}, {3}}) edges.add(edge);
  tet.add({0, 1});
  const CertifyOptions none{.passes = 0};
  EXPECT_EQ(certify::certify(graph, {2, 3}, {edges, tet}, none, no_deadline).cover.size(), 4);
  EXPECT_EQ(certify::certify(graph, {2, 3}, {std::nullopt, tet}, none, no_deadline).cover.members,
            (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(certify::certify(graph, {2, 3}, {}, none, no_deadline).cover.size(), 2);
  const CertifyResult result = certify::certify(graph, {2, 3}, {std::nullopt, tet}, {}, no_deadline);
  EXPECT_EQ(result.dual.bound, 904) << "a vertex without a clique counts in full";
}

TEST(Certify, TakesTheExtremes) {
  const CertifyResult empty = certify::certify({}, {}, {}, {}, no_deadline);
  EXPECT_TRUE(empty.complete && empty.maximal);
  EXPECT_EQ(empty.gap, 0);
  const CertifyResult zero = certify::certify(make_graph({0}, {}), {0}, {}, {}, no_deadline);
  EXPECT_TRUE(zero.complete);
  const std::int64_t huge = std::int64_t{1} << 61;
  const CertifyResult large = certify::certify(make_graph({huge, huge}, {{0, 1}}), {0}, {}, {}, no_deadline);
  EXPECT_GE(large.dual.bound, huge);
}

}  // namespace
}  // namespace hexpipe
