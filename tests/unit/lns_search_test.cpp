#include <gtest/gtest.h>

#include <new>
#include <set>

#include "common/mwis/local_search/fragment.hpp"
#include "common/mwis/local_search/fragment_solver.hpp"
#include "common/mwis/local_search/lns.hpp"
#include "common/mwis/local_search/schedule.hpp"
#include "common/run/parallel.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace mwis;
using namespace graph;
using namespace mwis::ground;
using namespace mwis::local_search;
namespace {

using hexpipe::testing::brute_force_weight;
using hexpipe::testing::make_graph;
using hexpipe::testing::no_deadline;

// The vertices that are free by the definition once `released` are no longer chosen.
std::set<std::int32_t> free_vertices(const SolutionState& state, const std::vector<std::int32_t>& released) {
  const std::set<std::int32_t> gone(released.begin(), released.end());
  std::set<std::int32_t> free;
  for (std::int32_t v = 0; v < state.graph().vertex_count(); ++v) {
    bool blocked = state.contains(v) ? !gone.contains(v) : state.tightness(v) == 0;
    state.for_each_chosen_neighbour(v, [&](std::int32_t u) { blocked = blocked || !gone.contains(u); });
    if (!blocked) free.insert(v);
  }
  return free;
}

std::size_t component_size(const ConflictGraph& graph, std::int32_t seed) {
  std::set<std::int32_t> reached{seed};
  for (std::vector<std::int32_t> queue{seed}; !queue.empty();) {
    const std::int32_t v = queue.back();
    queue.pop_back();
    for (const std::int32_t u : graph.neighbours_of(v))
      if (reached.insert(u).second) queue.push_back(u);
  }
  return reached.size();
}

TEST(FragmentGrower, FreesWhatTheReleasedBlocked) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_clique_graph(120, 100, 20, random);
    SolutionState state(graph);
    state.make_maximal();
    FragmentGrower grower(state, Random(9));
    Fragment fragment;
    for (const std::int32_t seed : state.to_set()) {
      const std::size_t target = 1 + random.below(60);
      grower.let_go();
      grower.grow(seed, target, 1000, fragment);
      EXPECT_EQ(fragment.released.front(), seed);
      EXPECT_EQ(std::set(fragment.vertices.begin(), fragment.vertices.end()), free_vertices(state, fragment.released));
      EXPECT_TRUE(fragment.vertices.size() >= target || fragment.whole_component);
      EXPECT_TRUE(!fragment.whole_component || fragment.vertices.size() == component_size(graph, seed));
    }
  }
}

TEST(FragmentGrower, FragmentsOfARoundDoNotTouch) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_clique_graph(200, 150, 20, random);
    SolutionState state(graph);
    state.make_maximal();
    FragmentGrower grower(state, Random(9));
    grower.let_go();
    std::vector<Fragment> fragments;
    for (const std::int32_t seed : state.to_set()) {
      if (!grower.is_free(seed)) continue;
      grower.grow(seed, 20, 25, fragments.emplace_back());
      EXPECT_LE(fragments.back().vertices.size(), 25u + 1);
    }
    std::vector<int> owner(200, -1);
    for (std::size_t f = 0; f < fragments.size(); ++f)
      for (const std::int32_t v : fragments[f].vertices) {
        EXPECT_EQ(owner[v], -1);
        owner[v] = static_cast<int>(f);
      }
    for (std::int32_t v = 0; v < 200; ++v)
      for (const std::int32_t u : graph.neighbours_of(v))
        EXPECT_TRUE(owner[u] < 0 || owner[v] < 0 || owner[u] == owner[v]) << "graph " << i;
  }
}

TEST(FragmentGrower, KnowsWhenItHasAWholeComponent) {
  const ConflictGraph two_paths = make_graph({1, 2, 1, 1, 2, 1}, {{0, 1}, {1, 2}, {3, 4}, {4, 5}});
  const SolutionState state(two_paths, {1, 3, 5});
  FragmentGrower grower(state, Random(9));
  Fragment fragment;
  grower.let_go();
  grower.grow(3, 100, 1000, fragment);
  EXPECT_TRUE(fragment.whole_component);
  EXPECT_EQ(fragment.vertices.size(), 3u);
  grower.let_go();
  grower.grow(3, 1, 1000, fragment);
  EXPECT_FALSE(fragment.whole_component);
  EXPECT_EQ(fragment.frontier, (std::vector<std::int32_t>{5}));
  grower.let_go();
  grower.grow(1, 100, 2, fragment);
  EXPECT_FALSE(fragment.whole_component) << "the limit left a vertex out";
  EXPECT_EQ(fragment.vertices.size(), 2u);
}

TEST(FragmentGrower, ExtractsTheGraphOfItsVertices) {
  const ConflictGraph path = make_graph({1, 2, 3, 4}, {{0, 1}, {1, 2}, {2, 3}});
  const SolutionState state(path, {1, 3});
  FragmentGrower grower(state, Random(9));
  Fragment fragment;
  grower.let_go();
  grower.grow(1, 2, 1000, fragment);
  DenseGraph dense;
  std::vector<bits::Word> chosen;
  grower.extract(fragment, dense, chosen);
  ASSERT_EQ(fragment.vertices, (std::vector<std::int32_t>{1, 0}));
  EXPECT_TRUE(dense.has_edge(0, 1));
  EXPECT_EQ(dense.weight(0), 2);
  EXPECT_EQ(dense.weight(1), 1);
  EXPECT_EQ(chosen[0], 1u);
}

TEST(Schedule, GivesTheLeastTriedFirst) {
  Schedule schedule(4, 10, 100, Random(1));
  EXPECT_FALSE(schedule.take());
  for (const std::int32_t v : {0, 1, 2}) schedule.renew(v);
  std::set<std::int32_t> first;
  for (int i = 0; i < 3; ++i) {
    const auto v = schedule.take();
    ASSERT_TRUE(v);
    first.insert(*v);
    schedule.retire(*v);
  }
  EXPECT_EQ(first, (std::set<std::int32_t>{0, 1, 2}));
  schedule.renew(3);
  EXPECT_EQ(schedule.take(), 3);
  schedule.close(0);
  schedule.retire(1);
  EXPECT_EQ(schedule.take(), 2) << "tried once, before 1, tried twice; 0 is closed";
  EXPECT_EQ(schedule.take(), 1);
  EXPECT_FALSE(schedule.take());
}

// A search that can prove nothing goes on for hours around the same few places.
TEST(Schedule, CountsNoMoreTriesThanItHasListsFor) {
  Schedule schedule(2, 50, 200, Random(1));
  for (std::uint32_t i = 0; i < Schedule::most_tries + 10; ++i) schedule.retire(0), schedule.take();
  EXPECT_EQ(schedule.tries_at(0), Schedule::most_tries);
  schedule.recall(1, Schedule::most_tries + 1, 50);
  EXPECT_EQ(schedule.tries_at(1), Schedule::most_tries);
  schedule.retire(0);
  EXPECT_TRUE(schedule.take() && schedule.take());
  EXPECT_FALSE(schedule.take());
}

TEST(Schedule, AdaptsSizesWithinLimits) {
  Schedule schedule(1, 50, 100, Random(1));
  EXPECT_EQ(schedule.size_at(0), 50u);
  schedule.enlarge(0);
  EXPECT_GT(schedule.size_at(0), 50u);
  for (int i = 0; i < 20; ++i) schedule.enlarge(0);
  EXPECT_EQ(schedule.size_at(0), 100u);
  for (int i = 0; i < 50; ++i) schedule.shrink(0);
  EXPECT_GE(schedule.size_at(0), 1u);
  EXPECT_LE(schedule.size_at(0), 20u);
}

TEST(Schedule, ShrinksWhatIsSmallAlready) {
  Schedule schedule(1, 50, 5, Random(1));
  EXPECT_EQ(schedule.size_at(0), 5u);
  schedule.shrink(0);
  EXPECT_EQ(schedule.size_at(0), 5u) << "no more than the largest";
  Schedule small(1, 10, 100, Random(1));
  small.shrink(0);
  EXPECT_EQ(small.size_at(0), 10u) << "no more than before";
}

TEST(FragmentGrower, LetsGoOfFragmentsInAnyOrder) {
  const ConflictGraph paths = make_graph({1, 2, 1, 1, 2, 1, 1}, {{0, 1}, {1, 2}, {3, 4}, {4, 5}});
  const SolutionState state(paths, {1, 4, 6});
  FragmentGrower grower(state, Random(9));
  Fragment first, second, third;
  grower.grow(1, 3, 1000, first);
  grower.grow(4, 3, 1000, second);
  EXPECT_FALSE(grower.is_free(0));
  EXPECT_FALSE(grower.is_free(4));
  EXPECT_TRUE(grower.is_free(6));
  grower.let_go(second);
  EXPECT_FALSE(grower.is_free(0));
  EXPECT_TRUE(grower.is_free(4));
  grower.grow(6, 1, 1000, third);
  grower.let_go(first);
  EXPECT_TRUE(grower.is_free(0));
  EXPECT_FALSE(grower.is_free(6));
  grower.let_go();
  EXPECT_TRUE(grower.is_free(6));
}

TEST(OperatorSelection, FollowsTheYield) {
  constexpr double work = 1e8;
  OperatorSelection selection({Operator::exact, Operator::anneal});
  EXPECT_EQ(selection.share_of(Operator::exact), 0.5);
  const auto share_done = [&](double exact_gain, double anneal_gain) {
    int exact = 0;
    for (int i = 0; i < 100; ++i) {
      const Operator op = selection.next();
      exact += op == Operator::exact;
      selection.record(op, work, op == Operator::exact ? exact_gain : anneal_gain);
    }
    return exact;
  };
  EXPECT_NEAR(share_done(0, 0), 50, 1) << "nothing is gained";
  EXPECT_NEAR(share_done(100, 1), 80, 5);
  EXPECT_NEAR(share_done(1, 100), 20, 10);
}

TEST(OperatorSelection, CountsWorkThatTakesNoTime) {
  OperatorSelection selection({Operator::exact, Operator::anneal});
  int exact = 0;
  for (int i = 0; i < 100; ++i) {
    const Operator op = selection.next();
    exact += op == Operator::exact;
    selection.record(op, op == Operator::exact ? 5000 : 0, 0);
  }
  EXPECT_GT(exact, 10);
}

TEST(OperatorSelection, SharesAmongTheOperatorsItIsGiven) {
  OperatorSelection all, alone({Operator::recombine});
  EXPECT_NEAR(all.share_of(Operator::exact) + all.share_of(Operator::anneal) + all.share_of(Operator::recombine), 1,
              1e-12);
  EXPECT_EQ(alone.next(), Operator::recombine);
  EXPECT_NEAR(alone.share_of(Operator::recombine), 1, 1e-12);
  std::array<int, all_operators.size()> done{};
  for (int i = 0; i < 300; ++i) {
    const Operator op = all.next();
    ++done[index_of(op)];
    all.record(op, 1e8, op == Operator::recombine ? 100 : 0);
  }
  EXPECT_GT(done[index_of(Operator::recombine)], 150);
  EXPECT_GT(done[index_of(Operator::exact)], 20);
  EXPECT_GT(done[index_of(Operator::anneal)], 20);
}

TEST(OperatorSelection, KeepsTheLeastShares) {
  OperatorSelection selection({all_operators.begin(), all_operators.end()}, {0.1, 0.1, 0.5});
  for (int i = 0; i < 100; ++i) {
    const Operator op = selection.next();
    selection.record(op, 1e8, op == Operator::exact ? 100 : 0);
  }
  EXPECT_NEAR(selection.share_of(Operator::exact), 0.4, 1e-6);
  EXPECT_NEAR(selection.share_of(Operator::anneal), 0.1, 1e-6);
  EXPECT_NEAR(selection.share_of(Operator::recombine), 0.5, 1e-6);
}

TEST(FragmentSolver, NeverLosesWithAnyOperator) {
  Random random(11);
  for (int i = 0; i < 40; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_clique_graph(200, 150, 1000, random);
    SolutionState state(graph);
    state.make_maximal();
    FragmentGrower grower(state, Random(9));
    const std::int32_t seed = state.to_set()[random.below(state.to_set().size())];
    for (const Operator op : all_operators) {
      grower.let_go();
      FragmentSolver solver;
      solver.begin(op);
      grower.grow(seed, 60, 120, solver.fragment());
      solver.extract(grower);
      ShortCoolings of_graph(graph, {}, Random(i));
      solver.solve(op == Operator::exact ? 1000 : 20, Random(i), no_deadline, {}, i % 2 == 0 ? &of_graph : nullptr);
      std::int64_t before = 0, after = 0;
      IndependentSet chosen;
      const auto& vertices = solver.fragment().vertices;
      for (std::size_t place = 0; place < vertices.size(); ++place) {
        if (state.contains(vertices[place])) before += graph.weights[vertices[place]];
        if (solver.chooses(place)) chosen.push_back(vertices[place]);
      }
      std::ranges::sort(chosen);
      ASSERT_NO_THROW(validate(chosen, graph, "fragment"));
      after = total_weight(chosen, graph);
      EXPECT_GE(after, before);
      EXPECT_GT(solver.work(), 0);
    }
  }
}

TEST(FragmentSolver, RecombinesShortCoolings) {
  Random random(12);
  const ConflictGraph graph = hexpipe::testing::random_graph(600, 0.1, 200, random);
  const auto weight_with = [&](bool short_coolings, int index) {
    SolutionState state(graph);
    state.make_maximal();
    FragmentGrower grower(state, Random(9));
    FragmentSolver solver;
    solver.begin(Operator::recombine);
    grower.grow(state.to_set().front(), 600, 600, solver.fragment());
    solver.extract(grower);
    ShortCoolings search(graph, {}, Random(index));
    solver.solve(2, Random(index), no_deadline, Cooling::for_chosen(50), short_coolings ? &search : nullptr);
    std::int64_t weight = 0;
    for (std::size_t i = 0; i < solver.fragment().vertices.size(); ++i)
      if (solver.chooses(i)) weight += graph.weights[solver.fragment().vertices[i]];
    return weight;
  };
  std::int64_t with = 0, without = 0;  // a quarter of those with short coolings anneal by kicks
  for (int i = 0; i < 10; ++i) with += weight_with(true, i), without += weight_with(false, i);
  EXPECT_GT(with, without);
}

// A fragment that is the whole graph goes on with its coolings; others do not touch them.
TEST(FragmentSolver, GoesOnWithTheCoolingsOfTheWholeGraph) {
  Random random(13);
  const ConflictGraph graph = hexpipe::testing::random_graph(300, 0.1, 200, random);
  ShortCoolings of_graph(graph, {}, Random(1));
  for (const std::size_t size : {std::size_t{300}, std::size_t{100}}) {
    const double before = of_graph.touched();
    for (int i = 0; i < 10; ++i) {  // a quarter of them anneal by kicks
      SolutionState state(graph);
      state.make_maximal();
      FragmentGrower grower(state, Random(9));
      FragmentSolver solver;
      solver.begin(Operator::recombine);
      grower.grow(state.to_set().front(), size, size, solver.fragment());
      solver.extract(grower);
      solver.solve(1, Random(i), no_deadline, Cooling::for_chosen(50), &of_graph);
    }
    EXPECT_EQ(of_graph.touched() > before, size == 300);
  }
}

TEST(Lns, FindsTheOptimumOfSmallGraphs) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const ConflictGraph graph = i % 2 == 0 ? hexpipe::testing::random_graph(20, 0.2, 50, random)
                                           : hexpipe::testing::random_clique_graph(20, 40, 50, random);
    const LnsResult result = improve_by_lns(graph, {}, {.iterations = 100}, no_deadline);
    ASSERT_NO_THROW(validate(result.solution, graph, "solution"));
    EXPECT_EQ(result.weight, brute_force_weight(graph)) << "graph " << i;
    EXPECT_EQ(result.weight, total_weight(result.solution, graph));
    EXPECT_TRUE(result.complete) << "graph " << i;
  }
}

TEST(Lns, IsNeverWorseThanItsStart) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_clique_graph(300, 200, 1000, random);
    SolutionState start(graph);
    start.make_maximal();
    std::int64_t weight = start.weight();
    for (const std::int64_t iterations : {0, 1, 10, 100}) {
      const LnsResult result = improve_by_lns(
          graph, start.to_set(), {.iterations = iterations, .fragment_size = 30, .node_limit = 3}, no_deadline);
      EXPECT_GE(result.weight, weight);
      EXPECT_LE(result.iterations, iterations);
      ASSERT_NO_THROW(validate(result.solution, graph, "solution"));
      weight = result.weight;
    }
  }
}

TEST(Lns, KeepsZeroWeightsAndHugeOnes) {
  const std::int64_t huge = std::int64_t{1} << 60;
  const ConflictGraph graph = make_graph({0, huge, huge + 1, huge, 0}, {{1, 2}, {2, 3}});
  const LnsResult result = improve_by_lns(graph, {2}, {}, no_deadline);
  EXPECT_EQ(result.solution, (IndependentSet{0, 1, 3, 4})) << "maximal with the zeros";
  EXPECT_EQ(result.weight, 2 * huge);
  EXPECT_TRUE(result.complete);
}

TEST(Lns, TakesTheExtremes) {
  EXPECT_TRUE(improve_by_lns({}, {}, {}, no_deadline).complete);
  EXPECT_EQ(improve_by_lns(make_graph({0}, {}), {}, {}, no_deadline).solution, (IndependentSet{0}));
  Random random(5);
  const ConflictGraph complete = hexpipe::testing::random_graph(300, 1.0, 100000, random);
  const LnsResult result = improve_by_lns(complete, {0}, {.fragment_size = 10}, no_deadline);
  EXPECT_EQ(result.weight, std::ranges::max(complete.weights));
  // A star whose centre frees more than branch and bound may be given.
  std::vector<std::pair<std::int32_t, std::int32_t>> spokes;
  std::vector<std::int64_t> weights{5000};
  for (std::int32_t v = 1; v <= 6000; ++v) spokes.emplace_back(0, v), weights.push_back(1);
  const ConflictGraph star = make_graph(weights, spokes);
  EXPECT_EQ(
      improve_by_lns(star, {0}, {.iterations = 20, .annealed_fragment = 0, .recombined_fragment = 0, .reduce = false},
                     no_deadline)
          .weight,
      5000);
  for (const bool reduce : {false, true})
    EXPECT_EQ(improve_by_lns(star, {0}, {.iterations = 40, .reduce = reduce}, no_deadline).weight, 6000);
}

TEST(Lns, DoesNotDependOnThreads) {
  Random random(6);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(2000, 1500, 1000, random);
  const LnsOptions options{.iterations = 200, .fragment_size = 40};
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return improve_by_lns(graph, {}, options, no_deadline).solution;
  };
  const IndependentSet one = with_threads(1);
  EXPECT_EQ(one, with_threads(2));
  EXPECT_EQ(one, with_threads(1));
}

TEST(Lns, RunsFreely) {
  Random random(10);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(2000, 1500, 1000, random);
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    const LnsOptions options{.iterations = 300, .fragment_size = 40, .free_running = true};
    const LnsResult none = improve_by_lns(graph, {}, {.iterations = 0}, no_deadline);
    const LnsResult result = improve_by_lns(graph, none.solution, options, no_deadline);
    ASSERT_NO_THROW(validate(result.solution, graph, "solution"));
    EXPECT_EQ(result.weight, total_weight(result.solution, graph));
    EXPECT_GT(result.weight, none.weight);
    EXPECT_LE(result.iterations, 300);
  }
}

// A fragment is the whole graph, and takes long enough for the other threads to come and wait for it.
TEST(Lns, EndsAFreeRunInWhichAThreadThrows) {
  Random random(13);
  const ConflictGraph graph = hexpipe::testing::random_graph(1000, 0.05, 1000, random);
  const ThreadLimit limit(4);
  const LnsOptions options{.fragment_size = 1000,
                           .node_limit = 1000,
                           .annealed_fragment = 0,
                           .recombined_fragment = 0,
                           .reduce = false,
                           .free_running = true};
  for (int i = 0; i < 3; ++i)
    EXPECT_THROW(improve_by_lns(graph, {}, options, no_deadline, [](const LnsProgress&) { throw std::bad_alloc(); }),
                 std::bad_alloc);
}

TEST(Lns, EndsWhereVerticesAreIsolated) {
  ConflictGraph isolated;
  isolated.weights.assign(60, 1);
  isolated.offsets.assign(61, 0);
  const LnsResult result = improve_by_lns(isolated, {}, {.iterations = 5000, .reduce = false}, no_deadline);
  EXPECT_TRUE(result.complete);
  EXPECT_LT(result.iterations, 5000);
}

// A fragment that is its whole component is no proof where branch and bound met its limit.
TEST(Lns, ClaimsNoProofThatALimitCutShort) {
  Random random(14);
  int unproven = 0;
  for (int i = 0; i < 100; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(22, 0.3, 3, random);
    LnsOptions options{.iterations = 3, .node_limit = 1, .annealed_fragment = 0, .recombined_fragment = 0};
    options.reduce = false;
    const LnsResult result = improve_by_lns(graph, {}, options, no_deadline);
    const bool optimal = result.weight == brute_force_weight(graph);
    EXPECT_TRUE(optimal || !result.complete) << "graph " << i;
    unproven += optimal ? 0 : 1;
  }
  EXPECT_GT(unproven, 0);
}

// Reductions leave out u, which v could replace; x keeps v out, and p comes in, one lighter than u, until the search
// gets there. 150 of these hang on a core that does not reduce.
TEST(Lns, NeverGivesLessThanTheStart) {
  constexpr std::int32_t gadgets = 150;
  std::vector<std::int64_t> weights(gadgets, 20);
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::int32_t i = 0; i < gadgets; ++i)
    for (const std::int32_t step : {1, 17}) edges.emplace_back(i, (i + step) % gadgets);
  for (std::int32_t z = 0; z < gadgets; ++z) {
    const std::int32_t u = gadgets + 5 * z, v = u + 1, x = u + 2, y = u + 3, p = u + 4;
    for (const int weight : {2, 3, 1, 10, 1}) weights.push_back(weight);
    edges.insert(edges.end(), {{u, v}, {u, y}, {u, p}, {v, x}, {v, y}, {v, p}, {y, z}});
  }
  const ConflictGraph graph = make_graph(weights, edges);
  SolutionState core(graph);
  for (std::int32_t z = 0; z < gadgets; ++z)
    if (core.tightness(z) == 0) core.add(z);
  for (std::int32_t z = 0; z < gadgets; ++z) {
    const std::int32_t u = gadgets + 5 * z, x = u + 2, y = u + 3, p = u + 4;
    for (const std::int32_t w : core.contains(z) ? std::vector{u, x} : std::vector{y, x, p}) core.add(w);
  }
  LnsOptions options{.iterations = 40, .fragment_size = 8, .annealed_fragment = 0, .recombined_fragment = 0};
  std::int64_t last = core.weight();
  const LnsResult result = improve_by_lns(graph, core.to_set(), options, no_deadline, [&](const LnsProgress& now) {
    EXPECT_GT(now.weight, last);
    last = now.weight;
  });
  EXPECT_GE(result.weight, core.weight());
  EXPECT_EQ(total_weight(result.solution, graph), result.weight);
}

// The first fragment takes the centre out for some of the rays; the others have nothing chosen beside them then.
TEST(Lns, TakesWhatAFragmentLeftOut) {
  std::vector<std::pair<std::int32_t, std::int32_t>> spokes;
  for (std::int32_t v = 1; v <= 6; ++v) spokes.emplace_back(0, v);
  const ConflictGraph star = make_graph({2, 3, 3, 3, 3, 3, 3}, spokes);
  LnsOptions options{.iterations = 200, .fragment_size = 2, .annealed_fragment = 0, .recombined_fragment = 0};
  options.reduce = false;
  for (const bool free_running : {false, true}) {
    options.free_running = free_running;
    const LnsResult result = improve_by_lns(star, {0}, options, no_deadline);
    EXPECT_EQ(result.weight, 18);
    EXPECT_TRUE(result.complete);
  }
}

// Two of these are as good as the other two, and annealing comes from the hub to the first two.
TEST(Lns, GoesOnWhereEqualWeightsChangePlaces) {
  const ConflictGraph graph =
      make_graph({1, 1, 1, 1, 1}, {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 3}, {1, 4}, {2, 3}, {2, 4}});
  const LnsOptions options{.iterations = 5000,
                           .fragment_size = 1,
                           .largest_fragment = 1,
                           .annealed_fragment = 0,
                           .recombined_fragment = 5,
                           .reduce = false};
  const LnsResult result = improve_by_lns(graph, {3, 4}, options, no_deadline);
  EXPECT_EQ(result.solution, (IndependentSet{1, 2}));
  EXPECT_EQ(result.iterations, options.iterations);
}

TEST(Lns, EndsAtItsTarget) {
  Random random(12);
  const ConflictGraph graph = hexpipe::testing::random_graph(400, 0.1, 1000, random);
  const LnsResult start = improve_by_lns(graph, {}, {.iterations = 0}, no_deadline);
  for (const bool reduce : {false, true}) {
    const LnsOptions options{.iterations = 300, .fragment_size = 40, .reduce = reduce};
    const LnsResult whole = improve_by_lns(graph, start.solution, options, no_deadline);
    LnsOptions halfway = options;
    halfway.target = (start.weight + whole.weight) / 2;
    const LnsResult half = improve_by_lns(graph, start.solution, halfway, no_deadline);
    EXPECT_GE(half.weight, halfway.target);
    EXPECT_LT(half.iterations, whole.iterations);
    EXPECT_EQ(improve_by_lns(graph, half.solution, halfway, no_deadline).iterations, 0);
  }
}

TEST(Lns, ReportsRisingWeights) {
  Random random(7);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(500, 300, 1000, random);
  std::int64_t last = 0, count = 0;
  const LnsResult result = improve_by_lns(graph, {}, {.iterations = 100, .fragment_size = 20, .reduce = false},
                                          no_deadline, [&](const LnsProgress& now) {
                                            EXPECT_GT(now.weight, last);
                                            EXPECT_LE(now.iteration, 100);
                                            last = now.weight;
                                            ++count;
                                          });
  EXPECT_EQ(last, result.weight);
  EXPECT_EQ(count, result.improvements);
  EXPECT_GT(count, 0);
}

TEST(Lns, GoesOnFromWhatItRemembers) {
  Random random(9);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(2000, 1500, 1000, random);
  const LnsOptions options{.iterations = 100, .fragment_size = 40, .annealed_fragment = 0, .recombined_fragment = 0};
  LnsMemory memory;
  const LnsResult first = continue_lns(graph, {}, options, no_deadline, memory);
  ASSERT_EQ(memory.places.size(), first.solution.size());
  std::int64_t tried = 0, grown = 0;
  for (std::size_t i = 0; i < memory.places.size(); ++i) {
    EXPECT_EQ(memory.places[i].vertex, first.solution[i]);
    tried += memory.places[i].tries.front() > 0 ? 1 : 0;
    grown += memory.places[i].size > 40 ? 1 : 0;
  }
  EXPECT_GT(tried, 50);
  EXPECT_GT(grown, 50);
  // Places that were tried come last, so as many fragments again leave fewer places untried than without memory.
  const auto untried_after = [&](LnsMemory known) {
    continue_lns(graph, first.solution, options, no_deadline, known);
    return std::ranges::count_if(known.places, [](const auto& place) { return place.tries.front() == 0; });
  };
  EXPECT_LT(untried_after(memory), untried_after({}));
  // Remembered sizes are those of another search, whose limit may have been larger.
  for (LnsMemory::Place& place : memory.places) place.size = 4000000000;
  const LnsResult second = continue_lns(graph, first.solution, options, no_deadline, memory);
  EXPECT_GE(second.weight, first.weight);
  for (const LnsMemory::Place& place : memory.places) EXPECT_LE(place.size, options.largest_fragment);
}

TEST(Lns, StopsAtItsDeadline) {
  Random random(8);
  // Too hard to be solved in this time.
  const ConflictGraph graph = hexpipe::testing::random_graph(1000, 0.05, 1000, random);
  const Stopwatch watch;
  const Deadline deadline(0.2);
  const LnsResult result = improve_by_lns(graph, {}, {.fragment_size = 1000, .node_limit = 1000000000}, deadline);
  EXPECT_FALSE(result.complete);
  EXPECT_GE(watch.seconds(), 0.05);  // it keeps back what putting the result together takes, more of it under load
  EXPECT_LT(watch.seconds(), 1.0);   // a machine under load
}

}  // namespace
}  // namespace hexpipe
