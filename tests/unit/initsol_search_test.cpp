#include <gtest/gtest.h>

#include "common/mwis/local_search/annealing.hpp"
#include "common/run/parallel.hpp"
#include "random_graphs.hpp"
#include "tests/unit/random_cases.hpp"
#include "tools/initsol/initsol.hpp"

namespace hexpipe {
using namespace graph;
using namespace initsol;
namespace {

using hexpipe::testing::make_graph;
using hexpipe::testing::no_deadline;

TEST(Greedy, FollowsItsOrder) {
  // A star: the centre is the heaviest, the leaves bring more together.
  const ConflictGraph star = make_graph({9, 4, 4, 4}, {{0, 1}, {0, 2}, {0, 3}});
  EXPECT_EQ(greedy(star, merits(star, GreedyOrder::weight, {})), (IndependentSet{0}));
  EXPECT_EQ(greedy(star, merits(star, GreedyOrder::weight_degree, {})), (IndependentSet{0}));
  const ConflictGraph light_star = make_graph({5, 4, 4, 4}, {{0, 1}, {0, 2}, {0, 3}});
  EXPECT_EQ(greedy(light_star, merits(light_star, GreedyOrder::weight, {})), (IndependentSet{0}));
  EXPECT_EQ(greedy(light_star, merits(light_star, GreedyOrder::weight_degree, {})), (IndependentSet{1, 2, 3}));
  const std::vector<double> quality{0.1, 0.2, 0.05, 0.05};
  EXPECT_EQ(greedy(star, merits(star, GreedyOrder::quality, quality)), (IndependentSet{1, 2, 3}));
}

TEST(Greedy, IsMaximalAndBreaksTiesByNumber) {
  const ConflictGraph path = make_graph({0, 0, 0, 0}, {{0, 1}, {1, 2}, {2, 3}});
  EXPECT_EQ(greedy(path, merits(path, GreedyOrder::weight, {})), (IndependentSet{0, 2}));
}

TEST(IndexedHeap, AgreesWithALinearSearch) {
  Random random(1);
  IndexedHeap heap(50);
  std::vector<std::int64_t> keys(50, -1);  // -1: absent
  for (int step = 0; step < 5000; ++step) {
    const auto v = static_cast<std::int32_t>(random.below(50));
    const auto key = static_cast<std::int64_t>(random.below(20));
    if (keys[v] < 0)
      heap.insert(v, key), keys[v] = key;
    else if (random.below(2) == 0)
      heap.update(v, key), keys[v] = key;
    else
      heap.erase(v), keys[v] = -1;
    ASSERT_TRUE(heap.check());
    const auto best = std::ranges::max_element(keys);
    ASSERT_EQ(heap.empty(), *best < 0);
    if (heap.empty()) continue;
    EXPECT_EQ(heap.top_key(), *best);
    EXPECT_EQ(heap.top(), best - keys.begin());
  }
}

TEST(TabuSearch, StaysConsistentWithEveryWayOut) {
  Random random(2);
  for (const Escape escape : {Escape::restart, Escape::rebuild, Escape::best})
    for (int i = 0; i < 30; ++i) {
      const ConflictGraph graph = hexpipe::testing::random_graph(40, 0.2, 50, random);
      TabuSearch search(graph, {}, {.escape = escape, .tenure = 3, .patience = 20}, Random(i));
      std::int64_t best = search.best_weight();
      for (int round = 0; round < 20; ++round) {
        search.run(17, no_deadline);
        ASSERT_NO_FATAL_FAILURE(hexpipe::testing::check_consistency(search, graph));
        EXPECT_GE(search.best_weight(), best);
        best = search.best_weight();
      }
    }
}

TEST(TabuSearch, FindsTheOptimumOfSmallGraphs) {
  Random random(3);
  for (const Escape escape : {Escape::restart, Escape::rebuild, Escape::best}) {
    int optimal = 0;
    constexpr int graphs = hexpipe::testing::random_cases(100);
    for (int i = 0; i < graphs; ++i) {
      const ConflictGraph graph = hexpipe::testing::random_graph(22, 0.25, 50, random);
      TabuSearch search(graph, {}, {.escape = escape, .tenure = 3, .patience = 100}, Random(i));
      search.run(3000, no_deadline);
      optimal += search.best_weight() == hexpipe::testing::brute_force_weight(graph);
    }
    EXPECT_GE(optimal, graphs - graphs / 50) << "of " << graphs;
  }
}

// Every move is followed by a restart, and moves lead away from where it begins.
TEST(TabuSearch, KeepsAStartThatIsBetterThanTheBest) {
  Random random(13);
  for (int i = 0; i < hexpipe::testing::random_cases(100); ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(14, 0.4, 50, random);
    TabuSearch search(graph, {}, {.escape = Escape::restart, .tenure = 3, .patience = 1}, Random(i));
    search.run(3000, no_deadline);
    EXPECT_EQ(search.best_weight(), hexpipe::testing::brute_force_weight(graph)) << "graph " << i;
    EXPECT_EQ(total_weight(search.best(), graph), search.best_weight()) << "graph " << i;
  }
}

TEST(TabuSearch, EndsWhereNothingCanMove) {
  for (const ConflictGraph& graph : {ConflictGraph{}, make_graph({3}, {}), make_graph({3, 4}, {})}) {
    TabuSearch search(graph, {}, {}, Random(1));
    search.run(1000, no_deadline);
    EXPECT_EQ(search.moves(), 0);
    EXPECT_EQ(search.best().size(), graph.weights.size());
  }
}

TEST(TabuSearch, MovesInACompleteGraph) {
  Random random(4);
  const ConflictGraph graph = hexpipe::testing::random_graph(20, 1.0, 1000, random);
  TabuSearch search(graph, {}, {.tenure = 100}, Random(1));
  search.run(200, no_deadline);
  EXPECT_EQ(search.best_weight(), std::ranges::max(graph.weights));
  EXPECT_TRUE(search.check());
}

TEST(Initsol, NeverLosesWhatGreedyFound) {
  Random random(5);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(400, 120, 1000, random);
  const std::vector<double> quality(graph.weights.begin(), graph.weights.end());
  for (const Method method : {Method::anneal, Method::tabu})
    for (const GreedyOrder order : {GreedyOrder::weight, GreedyOrder::weight_degree, GreedyOrder::quality}) {
      const InitsolResult none =
          find_initial_solution(graph, quality, {.order = order, .method = method, .iterations = 0}, no_deadline);
      EXPECT_EQ(none.weight, none.greedy_weight);
      EXPECT_EQ(none.iterations, 0);
      const InitsolResult some = find_initial_solution(
          graph, quality, {.order = order, .method = method, .iterations = 5000, .reduce = false}, no_deadline);
      EXPECT_GT(some.weight, none.weight);
      EXPECT_EQ(total_weight(some.solution, graph), some.weight);
      EXPECT_NO_THROW(validate(some.solution, graph, "solution"));
    }
}

TEST(Initsol, AnnealsBetterTheSlowerItCools) {
  Random random(9);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(3000, 900, 1000, random);
  std::int64_t last = 0;
  for (const std::int64_t kicks : {500, 5000, 50000}) {
    const InitsolResult result = find_initial_solution(graph, {}, {.iterations = kicks, .reduce = false}, no_deadline);
    EXPECT_EQ(result.iterations, kicks);
    EXPECT_GT(result.weight, last);
    last = result.weight;
  }
}

// Given temperatures leave one long cooling alone.
TEST(Initsol, FindsMoreInDenseGraphsByShortCoolings) {
  Random random(10);
  const ConflictGraph graph = hexpipe::testing::random_graph(1000, 0.1, 200, random);
  const auto weight_with = [&](InitsolOptions options) {
    std::int64_t sum = 0;
    for (options.seed = 1; options.seed <= 3; ++options.seed)
      sum += find_initial_solution(graph, {}, options, no_deadline).weight;
    return sum;
  };
  // Given temperatures leave the short coolings out. They come on top of the long one.
  const auto usual = hexpipe::mwis::local_search::Cooling::for_chosen(70);
  EXPECT_GT(weight_with({.iterations = 3000}), weight_with({.hot = usual.hot, .cold = usual.cold, .iterations = 3000}));
}

TEST(Initsol, DoesNotDependOnThreads) {
  Random random(6);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(400, 120, 1000, random);
  const InitsolOptions options{.starts = 4, .iterations = 2500, .reduce = false};
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return find_initial_solution(graph, {}, options, no_deadline).solution;
  };
  EXPECT_EQ(with_threads(1), with_threads(2));
}

TEST(Initsol, MoreStartsAreNotWorse) {
  Random random(7);
  const ConflictGraph graph = hexpipe::testing::random_graph(200, 0.1, 1000, random);
  std::int64_t last = 0;
  for (const int starts : {1, 8}) {
    const auto result =
        find_initial_solution(graph, {}, {.starts = starts, .iterations = 300, .reduce = false}, no_deadline);
    EXPECT_GE(result.weight, last);
    EXPECT_EQ(result.iterations, 300 * starts);
    last = result.weight;
  }
}

TEST(Initsol, PutsStartsTogether) {
  Random random(12);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(3000, 900, 1000, random);
  const InitsolOptions two{.starts = 2, .iterations = 20000, .reduce = false};
  std::int64_t better_than_best = 0;
  const InitsolResult both = find_initial_solution(graph, {}, two, no_deadline,
                                                   [&](const InitsolProgress& now) { better_than_best = now.weight; });
  EXPECT_GT(both.weight, better_than_best) << "reported is the better of the two";
  EXPECT_NO_THROW(validate(both.solution, graph, "solution"));
  EXPECT_EQ(total_weight(both.solution, graph), both.weight);
}

TEST(Initsol, EndsAtOnceWhereReductionsSolveTheGraph) {
  Random random(10);
  for (int i = 0; i < 100; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(20, 0.2, 100, random);
    const InitsolResult result = find_initial_solution(graph, {}, {}, no_deadline);
    EXPECT_TRUE(result.complete);
    EXPECT_EQ(result.weight, hexpipe::testing::brute_force_weight(graph)) << "graph " << i;
    EXPECT_EQ(total_weight(result.solution, graph), result.weight);
    EXPECT_NO_THROW(validate(result.solution, graph, "solution"));
  }
}

TEST(Initsol, EndsByItselfAfterSoManyIterationsAVertex) {
  Random random(11);
  const ConflictGraph graph = hexpipe::testing::random_graph(900, 0.1, 1000, random);
  const InitsolResult whole =
      find_initial_solution(graph, {}, {.iterations_a_vertex = 3, .reduce = false}, no_deadline);
  EXPECT_EQ(whole.iterations, 3 * 900);
  const InitsolResult reduced = find_initial_solution(graph, {}, {.iterations_a_vertex = 3}, no_deadline);
  EXPECT_LE(reduced.iterations, 3 * 900);
  EXPECT_NO_THROW(validate(reduced.solution, graph, "solution"));
}

// Each vertex in conflict with so many others of a window that begins at it.
ConflictGraph random_band(std::int32_t vertices, std::int32_t neighbours, std::uint64_t window, Random& random) {
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::int32_t v = 0; v < vertices; ++v) {
    for (std::int32_t i = 0; i < neighbours; ++i) {
      const auto u = (v + 1 + static_cast<std::int32_t>(random.below(window))) % vertices;
      edges.emplace_back(v, u);
    }
  }
  return make_graph(hexpipe::testing::random_weights(vertices, 1000, random), edges);
}

TEST(Initsol, CoolsALargeGraphSlowlyOnlyWhereTrialsSaySo) {
  Random random(12);
  constexpr std::int32_t vertices = 20000;
  const InitsolOptions options{.iterations_a_vertex = 2, .tries_first = true, .reduce = false};
  // Every second trial gains something where vertices are in conflict with some of many.
  const ConflictGraph rugged = random_band(vertices, 8, 10000, random);
  const InitsolResult slow = find_initial_solution(rugged, {}, options, no_deadline);
  EXPECT_EQ(slow.iterations, 4 * vertices / 4 + 2 * vertices);
  // A local optimum is the best of cliques.
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::int32_t v = 0; v < vertices; ++v)
    for (std::int32_t u = v + 1; u % 8 != 0; ++u) edges.emplace_back(v, u);
  const std::vector<std::int64_t> weights = hexpipe::testing::random_weights(vertices, 1000, random);
  const ConflictGraph cliques = make_graph(weights, edges);
  const InitsolResult soon = find_initial_solution(cliques, {}, options, no_deadline);
  EXPECT_EQ(soon.iterations, vertices / 4) << "one trial, because it gains nothing";
  std::int64_t best = 0;
  for (std::int32_t v = 0; v < vertices; v += 8)
    best += *std::max_element(weights.begin() + v, weights.begin() + v + 8);
  EXPECT_EQ(soon.weight, best);
}

TEST(Initsol, TriesALargeGraphOnceMoreBeforeItCoolsSlowly) {
  Random random(13);
  constexpr std::int32_t vertices = 66000;
  const InitsolOptions options{.iterations_a_vertex = 1, .tries_first = true, .reduce = false};
  const InitsolResult result = find_initial_solution(random_band(vertices, 4, 10000, random), {}, options, no_deadline);
  EXPECT_EQ(result.iterations, (1 + 1 + 2 + 4) * vertices / 4 + vertices);
}

// Groups of 16 vertices against 24: greedy takes the 16, and no swap of one for two leaves this local optimum, which is
// far from the best.
ConflictGraph groups(std::int32_t count) {
  std::vector<std::int64_t> weights;
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::int32_t group = 0; group < count; ++group) {
    const auto first = static_cast<std::int32_t>(weights.size());
    weights.insert(weights.end(), 16, 59);
    weights.insert(weights.end(), 24, 40);
    for (std::int32_t few = first; few < first + 16; ++few)
      for (std::int32_t many = first + 16; many < first + 40; ++many) edges.emplace_back(few, many);
  }
  return make_graph(weights, edges);
}

TEST(Initsol, DoesNotCoolSlowlyBecauseTheFirstTrialsGainedMuch) {
  constexpr std::int32_t count = 500, vertices = 40 * count;
  const InitsolOptions options{.iterations_a_vertex = 2, .tries_first = true, .reduce = false};
  const InitsolResult result = find_initial_solution(groups(count), {}, options, no_deadline);
  EXPECT_EQ(result.greedy_weight, count * 16 * 59);
  EXPECT_GT(result.weight, 0.999 * count * 24 * 40);
  // Two trials, which find nearly all, and one of twice the length, which gains nothing.
  EXPECT_EQ(result.iterations, 4 * vertices / 4);
}

TEST(Initsol, TriesSmallGraphsForLonger) {
  constexpr std::int32_t count = 60, vertices = 40 * count;
  const InitsolOptions options{.iterations_a_vertex = 15, .tries_first = true, .reduce = false};
  const InitsolResult result = find_initial_solution(groups(count), {}, options, no_deadline);
  EXPECT_EQ(result.weight, count * 24 * 40);
  EXPECT_EQ(result.iterations, 4 * vertices) << "two trials of a move a vertex, and one of two";
  constexpr std::int32_t few = 40 * (count - 20);
  EXPECT_EQ(find_initial_solution(groups(count - 20), {}, options, no_deadline).iterations, 15 * few);
}

TEST(Initsol, StopsAtItsDeadline) {
  Random random(8);
  const ConflictGraph graph = hexpipe::testing::random_graph(300, 0.1, 1000, random);
  const Stopwatch watch;
  const Deadline deadline(0.1);
  find_initial_solution(graph, {}, {.reduce = false}, deadline);
  EXPECT_GE(watch.seconds(), 0.1);
  EXPECT_LT(watch.seconds(), 1.0);  // a machine under load
}

}  // namespace
}  // namespace hexpipe
