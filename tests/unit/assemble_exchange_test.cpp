#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "assemble_lattice.hpp"
#include "common/candidates/findhex.hpp"
#include "common/conflicts/find_conflicts.hpp"
#include "common/mesh/adjacency.hpp"
#include "common/mwis/ground/solution_state.hpp"
#include "common/run/error.hpp"
#include "common/run/parallel.hpp"
#include "tests/unit/random_cases.hpp"
#include "tools/assemble/assemble.hpp"
#include "tools/assemble/choice/exchange.hpp"
#include "tools/assemble/choice/exchange_search.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe {
using namespace assemble;
using namespace assemble::choice;
using namespace assemble::hybrid;
using namespace candidates;
using namespace conflicts;
using namespace graph;
using namespace mwis::ground;
namespace {

using testing::candidates_in;
using testing::jitter;
using testing::Lattice;
using testing::make_lattice;

IndependentSet set_of(const std::vector<CandidateIndex>& candidates) {
  return {candidates.begin(), candidates.end()};
}

// A lattice with all cells that findhex sees in it, cubes and cells across these, and their conflicts.
class Scene {
 public:
  explicit Scene(Lattice lattice, const std::vector<CellKind>& kinds = {CellKind::hex})
      : mesh(std::move(lattice.mesh)) {
    const TetAdjacency adjacency(mesh, "lattice");
    complete_surface(mesh, adjacency);
    candidates = findhex(mesh, {.kinds = kinds}, "lattice").candidates;
    graph = conflict_graph(candidates, {.weight = WeightKind::count, .weight_scale = 1}, "lattice");
    tags.emplace(mesh);
    boundary.emplace(mesh, adjacency, *tags);
  }

  Exchange exchange(const IndependentSet& chosen) const {
    return exchange_hexes(mesh, *boundary, candidates,
                          Selection(mesh, *tags, candidates, candidates_in(chosen)).choice());
  }

  // `first`, and whatever else fits, in random order.
  IndependentSet maximal_choice(const IndependentSet& first, Random& random) const {
    SolutionState state(graph, first);
    std::vector<std::int32_t> order(candidates.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
    random.shuffle(std::span(order));
    for (const std::int32_t i : order)
      if (!state.contains(i) && state.tightness(i) == 0) state.add(i);
    return state.to_set();
  }

  std::int64_t open_quads(const IndependentSet& chosen) const {
    const SurfaceTags fresh(mesh);
    const Selection selection(mesh, fresh, candidates, candidates_in(chosen));
    return static_cast<std::int64_t>(choice::open_quads(selection.mesh()).size());
  }

  double volume_of_hexes(const IndependentSet& chosen) const {
    double volume = 0;
    for (const std::int32_t i : chosen)
      if (candidates.kind[i] == CellKind::hex) volume += candidates.volume[i];
    return volume;
  }

  TetMesh mesh;
  Candidates candidates;
  ConflictGraph graph;

 private:
  std::optional<SurfaceTags> tags;
  std::optional<BoundaryQuads> boundary;
};

// A lattice whose points are moved at random.
Scene jittered_scene(int cubes, Random& random) {
  Lattice lattice = make_lattice(cubes);
  jitter(lattice, 0.1, random);
  return Scene(std::move(lattice));
}

bool is_cube(const Candidates& candidates, std::int32_t i) {
  return candidates.kind[i] == CellKind::hex && candidates.quality[i] > 0.999;
}

// In a lattice of 2 x 2 x 2 eight cubes leave no quad open. A cell across them stands in the place of some.
TEST(Exchange, ACellAcrossCubesGivesWayToThem) {
  const Scene scene(make_lattice(2));
  int across = 0;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(scene.candidates.size()); ++i) {
    if (is_cube(scene.candidates, i)) continue;
    ++across;
    SCOPED_TRACE(i);
    SolutionState state(scene.graph, {i});
    for (std::int32_t cube = 0; cube < scene.graph.vertex_count(); ++cube)
      if (is_cube(scene.candidates, cube) && state.tightness(cube) == 0) state.add(cube);
    Random random(1);
    const auto chosen = scene.maximal_choice(state.to_set(), random);
    const Exchange exchange = scene.exchange(chosen);
    EXPECT_EQ(exchange.chosen.size(), 8u);
    EXPECT_EQ(exchange.counts.open_quads_before, scene.open_quads(chosen));
    EXPECT_EQ(exchange.counts.open_quads_after, 0);
    EXPECT_EQ(scene.open_quads(set_of(exchange.chosen)), 0);
  }
  EXPECT_GT(across, 10);
}

// Selection, from which open quads are counted here, refuses cells that cannot stand together.
TEST(Exchange, LeavesFewerQuadsOpenAndHexesWithMoreVolume) {
  for (std::uint64_t seed = 1; seed <= hexpipe::testing::random_cases(20); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    // Two regions, whose interface cells do not cross but quads of both lie on.
    auto lattice = make_lattice(4, [](int i, int, int) { return i < 2 ? 1 : 2; });
    jitter(lattice, 0.1, random);
    const Scene scene(std::move(lattice));
    const auto chosen = scene.maximal_choice({}, random);
    const Exchange exchange = scene.exchange(chosen);
    EXPECT_NO_THROW(validate(set_of(exchange.chosen), scene.graph, "exchanged"));
    EXPECT_EQ(exchange.counts.open_quads_before, scene.open_quads(chosen));
    EXPECT_EQ(exchange.counts.open_quads_after, scene.open_quads(set_of(exchange.chosen)));
    EXPECT_LT(exchange.counts.open_quads_after, exchange.counts.open_quads_before);
    EXPECT_GT(scene.volume_of_hexes(set_of(exchange.chosen)), scene.volume_of_hexes(chosen));
    IndependentSet out, in;
    std::ranges::set_difference(chosen, set_of(exchange.chosen), std::back_inserter(out));
    std::ranges::set_difference(set_of(exchange.chosen), chosen, std::back_inserter(in));
    EXPECT_EQ(exchange.counts.hexes_out, static_cast<std::int64_t>(out.size()));
    EXPECT_EQ(exchange.counts.hexes_in, static_cast<std::int64_t>(in.size()));
  }
}

TEST(Exchange, APartialChoiceIsNotFilledUp) {
  for (std::uint64_t seed = 1; seed <= hexpipe::testing::random_cases(20); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = make_lattice(4);
    jitter(lattice, 0.1, random);
    const Scene scene(std::move(lattice));
    const auto all = scene.maximal_choice({}, random);
    const double share = random.uniform(0.05, 0.5);
    IndependentSet some;
    std::ranges::copy_if(all, std::back_inserter(some), [&](std::int32_t) { return random.uniform() < share; });
    const IndependentSet exchanged = set_of(scene.exchange(some).chosen);
    // Two come for one here and there.
    EXPECT_LE(exchanged.size(), some.size() + 2);
    const SolutionState before(scene.graph, some);
    for (const std::int32_t i : exchanged) EXPECT_TRUE(before.contains(i) || before.tightness(i) > 0) << i;
  }
}

TEST(Exchange, NothingComesOfNothing) {
  const Scene scene(make_lattice(3));
  const Exchange exchange = scene.exchange({});
  EXPECT_TRUE(exchange.chosen.empty());
  EXPECT_EQ(exchange.counts.open_quads_after, 0);
}

TEST(Exchange, PrismsAndPyramidsStay) {
  std::int64_t exchanged = 0, others = 0;
  for (std::uint64_t seed = 1; seed <= hexpipe::testing::random_cases(10); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = make_lattice(4);
    jitter(lattice, 0.1, random);
    const Scene scene(std::move(lattice), {CellKind::hex, CellKind::prism, CellKind::pyramid});
    const auto of_other_kinds = [&](const IndependentSet& set) {
      IndependentSet result;
      std::ranges::copy_if(set, std::back_inserter(result),
                           [&](std::int32_t i) { return scene.candidates.kind[i] != CellKind::hex; });
      return result;
    };
    // Hexes for the most part, or there would be none to exchange.
    SolutionState state(scene.graph);
    for (std::int32_t i = 0; i < scene.graph.vertex_count(); ++i)
      if (scene.candidates.kind[i] == CellKind::hex && state.tightness(i) == 0 && random.uniform() < 0.3) state.add(i);
    const auto chosen = scene.maximal_choice(state.to_set(), random);
    const Exchange exchange = scene.exchange(chosen);
    EXPECT_NO_THROW(validate(set_of(exchange.chosen), scene.graph, "exchanged"));
    EXPECT_EQ(of_other_kinds(set_of(exchange.chosen)), of_other_kinds(chosen));
    exchanged += exchange.counts.hexes_in;
    others += static_cast<std::int64_t>(of_other_kinds(chosen).size());
  }
  EXPECT_GT(exchanged, 0);
  EXPECT_GT(others, 0);
}

// The second is pushed out by any third, if nobody looks before.
TEST(Exchange, CellsThatCannotStandTogetherAreAnError) {
  const Scene scene(make_lattice(3));
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const auto first = static_cast<std::int32_t>(random.below(scene.candidates.size()));
    const auto beside = scene.graph.neighbours_of(first);
    const std::int32_t second = beside[random.below(beside.size())];
    const IndependentSet pair{std::min(first, second), std::max(first, second)};
    EXPECT_THROW(assemble::assemble(scene.mesh, scene.candidates, pair, {.smooth = 0}), DataError)
        << first << ' ' << second;
  }
}

// Candidates of another program, of which the chosen ones can stand together.
TEST(Exchange, WhatNobodyChoseMayBeAnything) {
  Random random(3);
  const Scene scene = jittered_scene(4, random);
  const auto chosen = scene.maximal_choice({}, random);
  const auto chosen_or = [&](auto&& change) {
    Candidates changed;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(scene.candidates.size()); ++i) {
      append(changed, select(scene.candidates, std::vector{CandidateIndex(i)}));
      if (!std::ranges::binary_search(chosen, i)) change(changed);
    }
    return changed;
  };
  const auto without_last_tet = chosen_or([](Candidates& c) { c.tets.pop_back(), --c.tet_offsets.back(); });
  const auto without_slivers = chosen_or([](Candidates& c) {
    c.boundary_tets.resize(c.boundary_tet_offsets[c.size() - 1]);
    c.boundary_tet_offsets.back() = static_cast<std::int64_t>(c.boundary_tets.size());
  });
  const auto inverted = chosen_or([](Candidates& c) {
    auto& v = c.vertices.back();
    std::swap_ranges(v.begin(), v.begin() + 4, v.begin() + 4);
  });
  const auto huge = chosen_or([](Candidates& c) { c.quality.back() = 1e300, c.volume.back() = 1e308; });
  const auto negative = chosen_or([](Candidates& c) { c.quality.back() = -1e300, c.volume.back() = -1e308; });
  Candidates all_huge = scene.candidates;
  std::ranges::fill(all_huge.quality, 1e300);
  std::ranges::fill(all_huge.volume, 1e308);
  for (const Candidates& candidates : {without_last_tet, without_slivers, inverted, huge, negative, all_huge}) {
    const AssembleResult made = assemble::assemble(scene.mesh, candidates, chosen, {.smooth = 0});
    ASSERT_TRUE(made.statistics.exchange);
    EXPECT_LE(made.statistics.exchange->open_quads_after, made.statistics.exchange->open_quads_before);
  }
}

// Than 0.3, and than the poorest that is chosen.
TEST(Exchange, NothingPoorerComesIn) {
  Random random(3);
  Scene scene = jittered_scene(4, random);
  const auto chosen = scene.maximal_choice({}, random);
  const auto exchanged_where = [&](double poorest_chosen, double others) {
    for (std::int32_t i = 0; i < scene.graph.vertex_count(); ++i)
      scene.candidates.quality[i] = std::ranges::binary_search(chosen, i) ? 0.5 : others;
    scene.candidates.quality[chosen.front()] = poorest_chosen;
    return scene.exchange(chosen).counts.hexes_in;
  };
  EXPECT_GT(exchanged_where(0.5, 0.31), 0);
  EXPECT_EQ(exchanged_where(0.5, 0.29), 0);
  EXPECT_GT(exchanged_where(0.2, 0.29), 0);
  EXPECT_EQ(exchanged_where(0.2, 0.19), 0);
}

TEST(Exchange, IsTheSameForAnyNumberOfThreads) {
  Random random(3);
  const Scene scene = jittered_scene(5, random);
  const auto chosen = scene.maximal_choice({}, random);
  std::vector<IndependentSet> results;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    results.push_back(set_of(scene.exchange(chosen).chosen));
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(Exchange, IsAnOptionOfAssemble) {
  Random random(3);
  const Scene scene = jittered_scene(4, random);
  const auto chosen = scene.maximal_choice({}, random);
  const auto assembled = [&](AssembleOptions options) {
    return assemble::assemble(scene.mesh, scene.candidates, chosen, options);
  };
  const AssembleResult with = assembled({.smooth = 0});
  const AssembleResult without = assembled({.exchange = AssembleOptions::Exchange::none, .smooth = 0});
  ASSERT_TRUE(with.statistics.exchange);
  EXPECT_EQ(with.statistics.exchange->open_quads_before, scene.open_quads(chosen));
  EXPECT_GT(with.statistics.exchange->hexes_in, 0);
  EXPECT_FALSE(without.statistics.exchange);
  EXPECT_LT(with.mesh.pyramids.size(), without.mesh.pyramids.size());
  const AssembleResult open = assembled({.conformity = AssembleOptions::Conformity::none, .smooth = 0});
  EXPECT_FALSE(open.statistics.exchange);
}

// Graphs with random edges, weights and quads, each quad at most two candidates'.
ExchangeProblem random_problem(std::int32_t count, Random& random) {
  ExchangeProblem problem;
  std::vector<std::vector<std::int32_t>> neighbours(count);
  for (std::int32_t a = 0; a < count; ++a)
    for (std::int32_t b = a + 1; b < count; ++b)
      if (random.uniform() < 0.2) neighbours[a].push_back(b), neighbours[b].push_back(a);
  for (auto& list : neighbours) {
    std::ranges::sort(list);
    problem.graph.neighbours.insert(problem.graph.neighbours.end(), list.begin(), list.end());
    problem.graph.offsets.push_back(static_cast<std::int64_t>(problem.graph.neighbours.size()));
    problem.graph.weights.push_back(500 + static_cast<std::int64_t>(random.below(500)));
  }
  problem.quads.resize(count);
  for (auto& row : problem.quads) row.fill(no_index);
  for (const auto a : indices<Participant>(problem.quads.size()))
    for (int k = 0; k < 3; ++k) {
      const QuadIndex quad(problem.cost.size());
      problem.cost.push_back(50 + static_cast<std::int64_t>(random.below(100)));
      problem.fixed_cells.push_back(random.uniform() < 0.1 ? 1 : 0);
      problem.quads[a][k] = quad;
      const Participant b(random.below(static_cast<std::uint64_t>(count)));
      if (b != a && problem.fixed_cells.back() == 0) problem.quads[b][3 + k] = quad;
    }
  problem.usual.assign(count, 700);
  problem.stays.assign(count, 0);
  return problem;
}

// From the definition.
std::int64_t value_of(const ExchangeProblem& problem, const IndependentSet& set) {
  std::int64_t value = total_weight(set, problem.graph);
  auto cells = problem.fixed_cells;
  for (const auto i : as_indices<Participant>(set))
    for (const QuadIndex quad : problem.quads[i])
      if (quad != no_index) ++cells[quad];
  for (const auto quad : indices<QuadIndex>(cells.size()))
    if (cells[quad] == 1) value -= problem.cost[quad];
  return value;
}

IndependentSet greedy_set(const ConflictGraph& graph) {
  SolutionState state(graph);
  state.make_maximal();
  return state.to_set();
}

// The best value of all independent sets, by trying them.
std::int64_t best_value_of(const ExchangeProblem& problem, IndependentSet& set, std::int32_t next) {
  if (next == problem.graph.vertex_count()) return value_of(problem, set);
  std::int64_t best = best_value_of(problem, set, next + 1);
  if (std::ranges::any_of(set, [&](std::int32_t i) { return problem.graph.has_edge(i, next); })) return best;
  set.push_back(next);
  best = std::max(best, best_value_of(problem, set, next + 1));
  set.pop_back();
  return best;
}

TEST(ExchangeSearch, FindsTheBestOfSmallProblems) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const ExchangeProblem problem = random_problem(13, random);
    ExchangeSearch search(problem, greedy_set(problem.graph), random);
    search.run(20000, {.hot = 0.5, .cold = 0.01});
    IndependentSet none;
    EXPECT_EQ(search.best_value(), best_value_of(problem, none, 0));
  }
}

TEST(ExchangeSearch, KeepsWhatItCountsRightAndIsNeverWorse) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    ExchangeProblem problem = random_problem(60, random);
    const IndependentSet start = greedy_set(problem.graph);
    for (const auto i : indices<Participant>(problem.stays.size())) {
      if (random.uniform() > 0.1) continue;
      problem.stays[i] = 1;
      if (!std::ranges::binary_search(start, i)) continue;
      for (const auto u : as_indices<Participant>(problem.graph.neighbours_of(i))) problem.stays[u] = 1;
    }
    ExchangeSearch search(problem, start, random);
    EXPECT_EQ(search.value(), value_of(problem, start));
    std::int64_t best_before = search.best_value();
    for (int round = 0; round < 5; ++round) {
      search.run(1000, {.hot = 2, .cold = 0.5});
      EXPECT_TRUE(search.check());
      const IndependentSet best = search.best();
      EXPECT_NO_THROW(validate(best, problem.graph, "best"));
      EXPECT_EQ(search.best_value(), value_of(problem, best));
      EXPECT_GE(search.best_value(), best_before);
      best_before = search.best_value();
      for (const auto i : indices<Participant>(problem.stays.size()))
        EXPECT_TRUE(!problem.stays[i] || std::ranges::binary_search(best, i) == std::ranges::binary_search(start, i));
    }
  }
}

}  // namespace
}  // namespace hexpipe
