#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <set>

#include "common/conflicts/quad_vertices.hpp"
#include "common/mwis/bounds/clique_dual.hpp"
#include "common/mwis/exact/exact_solver.hpp"
#include "common/mwis/local_search/annealing.hpp"
#include "common/mwis/local_search/lns.hpp"
#include "common/run/error.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace conflicts;
using namespace graph;
namespace {

using testing::add_candidate;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

// A hex, a prism and a hex that share its quad 4567 (the prism and the second hex on the other side), and a hex that
// shares a quad with nobody.
Candidates cells_at_a_quad() {
  Candidates cells;
  add_candidate(cells, CellKind::hex, {0, 1, 2, 3, 4, 5, 6, 7}, {}, 1);
  add_candidate(cells, CellKind::prism, {4, 5, 10, 7, 6, 11}, {}, 2);
  add_candidate(cells, CellKind::hex, {4, 5, 6, 7, 14, 15, 16, 17}, {}, 6);
  add_candidate(cells, CellKind::hex, {20, 21, 22, 23, 24, 25, 26, 27}, {});
  return cells;
}

TEST(QuadVertices, AreQuadsThatCandidatesCanShare) {
  const Candidates cells = cells_at_a_quad();
  ConflictGraph graph = hexpipe::testing::make_graph({10, 20, 30, 40}, {{1, 2}});
  QuadList quads = find_inner_quads(cells, graph, {}).shared;
  EXPECT_THAT(quads.quads, ElementsAre(VertexKey<4>{4, 5, 6, 7}));
  EXPECT_THAT(quads.candidates_at, ElementsAre(0, 1, 2));

  EXPECT_THAT(prices_of(quads, cells, {.weight_scale = 100}, 0.1, "test"), ElementsAre(10)) << "of quality 1";
  EXPECT_THAT(prices_of(quads, cells, {.weight = WeightKind::volume, .weight_scale = 100}, 0.1, "test"),
              ElementsAre(30))
      << "of the mean volume";
  add_quad_vertices(quads, {5}, graph, "test");
  EXPECT_EQ(graph, hexpipe::testing::make_graph({15, 25, 35, 40, 10}, {{1, 2}, {0, 4}, {1, 4}, {2, 4}}));

  const ConflictGraph all_in_conflict = hexpipe::testing::make_graph({1, 1, 1, 1}, {{0, 1}, {0, 2}, {1, 2}});
  EXPECT_THAT(find_inner_quads(cells, all_in_conflict, {}).shared.quads, IsEmpty());
}

TEST(QuadVertices, LonelyQuadsArePaidForAtOnce) {
  const Candidates cells = cells_at_a_quad();
  ConflictGraph graph = hexpipe::testing::make_graph({10, 20, 30, 3}, {{1, 2}});
  EXPECT_THAT(find_inner_quads(cells, graph, {}).lonely.quads, IsEmpty()) << "nobody knows the boundary";
  // All quads of the first hex but 4567 are on the boundary, with either diagonal, and so is half a quad of the last.
  KeySet<3> boundary{{0, 1, 2}, {0, 2, 3}, {0, 1, 5}, {0, 4, 5}, {1, 2, 5},   {2, 5, 6},
                     {2, 3, 7}, {2, 6, 7}, {0, 3, 4}, {3, 4, 7}, {20, 21, 22}};
  const InnerQuads quads = find_inner_quads(cells, graph, boundary);
  EXPECT_EQ(quads.shared.quads.size(), 1);
  EXPECT_EQ(std::ranges::count(quads.lonely.candidates_at, 0), 0);
  EXPECT_EQ(std::ranges::count(quads.lonely.candidates_at, 1), 2);
  EXPECT_EQ(std::ranges::count(quads.lonely.candidates_at, 2), 5);
  EXPECT_EQ(std::ranges::count(quads.lonely.candidates_at, 3), 6);
  pay_for_lonely_quads(quads.lonely, std::vector<std::int64_t>(quads.lonely.size(), 1), graph);
  EXPECT_THAT(graph.weights, ElementsAre(10, 18, 25, 0));
}

TEST(QuadVertices, FindTheBoundary) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  const KeySet<3> boundary = boundary_of(mesh, "test");
  EXPECT_EQ(boundary.size(), 6);
  EXPECT_FALSE(boundary.contains({1, 2, 3}));
  EXPECT_TRUE(boundary.contains({2, 3, 4}));
}

TEST(QuadVertices, RefuseWeightsThatDoNotFit) {
  constexpr std::int64_t large = std::numeric_limits<std::int64_t>::max() / 2;
  const Candidates cells = cells_at_a_quad();
  ConflictGraph graph = hexpipe::testing::make_graph({large, large, 0, 0}, {{1, 2}});
  const QuadList quads = find_inner_quads(cells, graph, {}).shared;
  EXPECT_THAT([&] { add_quad_vertices(quads, {large / 4}, graph, "test"); },
              ThrowsMessage<DataError>(HasSubstr("--weight-scale")));
  EXPECT_THAT([&] { prices_of(quads, cells, {.weight_scale = 1e20}, 1, "test"); },
              ThrowsMessage<DataError>(HasSubstr("--weight-scale")));
}

TEST(QuadVertices, AreInACliqueForEachSide) {
  // 4 and 5 are quads: 4 between the cliques 0 1 and 2 3, 5 beside 3 alone.
  const ConflictGraph graph =
      hexpipe::testing::make_graph({1, 1, 1, 1, 1, 1}, {{0, 1}, {2, 3}, {0, 4}, {1, 4}, {2, 4}, {3, 4}, {3, 5}});
  CliqueCover cover;
  add_cliques_at_last(graph, 4, cover);
  EXPECT_THAT(cover.offsets, ElementsAre(0, 3, 6, 8));
  EXPECT_THAT(cover.members, ElementsAre(0, 1, 4, 2, 3, 4, 3, 5));
}

// A plain graph, and quads between two of its cliques each.
struct Problem {
  ConflictGraph plain;
  QuadList quads;
  std::vector<std::int64_t> prices;
};

void add_quad(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b, std::int64_t price,
              Problem& problem) {
  QuadList& quads = problem.quads;
  std::vector<std::int32_t> both;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(both));
  quads.quads.push_back({});
  for (const std::int32_t candidate : both) quads.candidates_at.emplace_back(candidate);
  quads.offsets.push_back(std::ssize(quads.candidates_at));
  problem.prices.push_back(price);
}

// Grows a clique from a random vertex.
std::vector<std::int32_t> random_clique(const ConflictGraph& graph, Random& random) {
  std::vector<std::int32_t> clique;
  const auto vertices = static_cast<std::uint64_t>(graph.vertex_count());
  for (int tries = 0; tries < 8; ++tries) {
    const auto v = static_cast<std::int32_t>(random.below(vertices));
    if (std::ranges::all_of(clique, [&](std::int32_t u) { return graph.has_edge(u, v); })) clique.push_back(v);
  }
  std::ranges::sort(clique);
  return clique;
}

Problem random_problem(int index, Random& random) {
  Problem problem;
  const auto vertices = static_cast<std::int32_t>(1 + random.below(12));
  const std::int64_t heaviest = index % 3 == 0 ? 3 : 1000;
  problem.plain = index % 2 == 0 ? hexpipe::testing::random_graph(vertices, random.uniform(), heaviest, random)
                                 : hexpipe::testing::random_clique_graph(vertices, 20, heaviest, random);
  for (std::uint64_t left = random.below(7); left > 0; --left)
    add_quad(random_clique(problem.plain, random), random_clique(problem.plain, random),
             static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(heaviest) + 1)), problem);
  return problem;
}

// The weight of chosen candidates, less the prices of quads that exactly one of them has.
std::int64_t value_of(std::uint64_t chosen, const Problem& problem) {
  std::int64_t value = 0;
  for (std::int32_t v = 0; v < problem.plain.vertex_count(); ++v)
    if ((chosen >> v & 1) != 0) value += problem.plain.weights[v];
  for (std::size_t q = 0; q < problem.quads.size(); ++q) {
    int count = 0;
    for (std::int64_t i = problem.quads.offsets[q]; i < problem.quads.offsets[q + 1]; ++i)
      count += static_cast<int>(chosen >> problem.quads.candidates_at[i] & 1);
    if (count == 1) value -= problem.prices[q];
  }
  return value;
}

std::int64_t brute_force_value(const Problem& problem) {
  std::int64_t best = std::numeric_limits<std::int64_t>::min();
  const std::function<void(std::int32_t, std::uint64_t, std::uint64_t)> choose =
      [&](std::int32_t from, std::uint64_t chosen, std::uint64_t excluded) {
        if (from == problem.plain.vertex_count()) {
          best = std::max(best, value_of(chosen, problem));
          return;
        }
        choose(from + 1, chosen, excluded);
        if ((excluded >> from & 1) != 0) return;
        for (const std::int32_t u : problem.plain.neighbours_of(from)) excluded |= std::uint64_t{1} << u;
        choose(from + 1, chosen | std::uint64_t{1} << from, excluded);
      };
  choose(0, 0, 0);
  return best;
}

std::uint64_t bits_of(const IndependentSet& set, std::int32_t below) {
  std::uint64_t bits = 0;
  for (const std::int32_t v : set)
    if (v < below) bits |= std::uint64_t{1} << v;
  return bits;
}

// Every solver of plain graphs solves the problem with prices of open quads.
TEST(QuadVertices, MakeTheHeaviestSetTheBestChoice) {
  Random random(39);
  for (int i = 0; i < 4000; ++i) {
    const Problem problem = random_problem(i, random);
    const std::int32_t candidates = problem.plain.vertex_count();
    ConflictGraph graph = problem.plain;
    add_quad_vertices(problem.quads, problem.prices, graph, "test");
    ASSERT_NO_THROW(validate(graph, "test"));
    std::int64_t of_quads = 0;
    for (const std::int64_t price : problem.prices) of_quads += 2 * price;
    const std::int64_t best = brute_force_value(problem);

    // Exactly, as a fragment is solved.
    mwis::ground::DenseGraph dense = mwis::ground::dense_graph_of(graph);
    std::vector<mwis::bits::Word> chosen(dense.words(), 0);
    mwis::ground::SearchBudget budget;
    mwis::exact::ExactSolver solver;
    ASSERT_TRUE(solver.solve(dense, chosen, budget));
    IndependentSet set;
    mwis::bits::for_each(chosen.data(), chosen.size(),
                         [&](std::size_t v) { set.push_back(static_cast<std::int32_t>(v)); });
    ASSERT_NO_THROW(validate(set, graph, "test"));
    EXPECT_EQ(total_weight(set, graph) - of_quads, best) << "problem " << i;
    EXPECT_EQ(value_of(bits_of(set, candidates), problem), best) << "problem " << i;

    // What annealing takes for its weight is the value, and never more.
    mwis::local_search::Annealing annealing(graph, {}, Random(i));
    annealing.run(20, 1, Deadline());
    const IndependentSet annealed = annealing.best();
    EXPECT_EQ(annealing.best_weight() - of_quads, value_of(bits_of(annealed, candidates), problem)) << "problem " << i;
    EXPECT_LE(annealing.best_weight() - of_quads, best) << "problem " << i;
  }
}

TEST(QuadVertices, LeaveBoundsAndSearchesRight) {
  Random random(40);
  for (int i = 0; i < 200; ++i) {
    const Problem problem = random_problem(i, random);
    ConflictGraph graph = problem.plain;
    add_quad_vertices(problem.quads, problem.prices, graph, "test");
    std::int64_t of_quads = 0;
    for (const std::int64_t price : problem.prices) of_quads += 2 * price;
    const std::int64_t best = brute_force_value(problem);
    const auto found = mwis::local_search::improve_by_lns(graph, {}, {.iterations = 200}, Deadline());
    EXPECT_EQ(found.weight - of_quads, best) << "problem " << i;
    CliqueCover cover = greedy_edge_clique_cover(graph);
    EXPECT_GE(mwis::bounds::solve_clique_dual(graph, cover, {.passes = 50}, Deadline()).bound - of_quads, best);
  }
}

}  // namespace
}  // namespace hexpipe
