#include <gtest/gtest.h>

#include <functional>

#include "common/mwis/exact/branch_and_bound.hpp"
#include "common/mwis/exact/branch_and_reduce.hpp"
#include "common/mwis/exact/exact_solver.hpp"
#include "common/mwis/exact_algorithm.hpp"
#include "common/mwis/local_search/lns.hpp"
#include "common/mwis/reduce/dense_reductions.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace mwis;
using namespace graph;
using namespace mwis::exact;
using namespace mwis::ground;
using namespace mwis::local_search;
using namespace mwis::reduce;
namespace {

using hexpipe::testing::brute_force_weight;

// Calls test(graph, index) for graphs of many densities, sizes and ties, and of cliques in a ring.
void for_random_graphs(int count, const std::function<void(const ConflictGraph&, int)>& test) {
  Random random(7);
  for (int i = 0; i < count; ++i) {
    const auto vertices = static_cast<std::int32_t>(random.below(22));
    const std::int64_t heaviest = i % 3 == 0 ? 3 : 1000;
    test(i % 2 == 0 ? hexpipe::testing::random_graph(vertices, random.uniform(), heaviest, random)
                    : hexpipe::testing::random_clique_graph(vertices, 30, heaviest, random),
         i);
  }
}

std::int64_t checked_weight(const ConflictGraph& graph, const std::vector<bits::Word>& chosen) {
  IndependentSet set;
  bits::for_each(chosen.data(), chosen.size(), [&](std::size_t v) { set.push_back(static_cast<std::int32_t>(v)); });
  EXPECT_NO_THROW(validate(set, graph, "chosen"));
  return total_weight(set, graph);
}

TEST(BranchAndBound, AgreesWithBruteForce) {
  BranchAndBound solver;
  for_random_graphs(1000, [&](const ConflictGraph& graph, int index) {
    SearchBudget budget;
    const std::int64_t expected = brute_force_weight(graph);
    ASSERT_TRUE(solver.solve(dense_graph_of(graph), -1, budget)) << "graph " << index;
    EXPECT_EQ(solver.best_weight(), expected) << "graph " << index;
    std::vector<bits::Word> chosen(bits::words_for(graph.weights.size()));
    for (const std::uint32_t v : solver.best()) bits::insert(chosen.data(), v);
    EXPECT_EQ(checked_weight(graph, chosen), expected) << "graph " << index;
    EXPECT_FALSE(solver.solve(dense_graph_of(graph), expected, budget)) << "nothing is heavier, graph " << index;
    EXPECT_TRUE(solver.solve(dense_graph_of(graph), expected - 1, budget)) << "graph " << index;
  });
}

TEST(BranchAndBound, StopsAtItsBudget) {
  Random random(3);
  const DenseGraph graph = dense_graph_of(hexpipe::testing::random_graph(150, 0.1, 1000, random));
  BranchAndBound solver;
  SearchBudget budget(100);
  solver.solve(graph, -1, budget);
  EXPECT_TRUE(budget.exhausted());
  EXPECT_EQ(budget.spent(), 100);
  const Deadline passed(0.0);
  SearchBudget no_time(1000000, &passed);
  solver.solve(graph, -1, no_time);
  EXPECT_TRUE(no_time.exhausted());
  SearchBudget at_once(1000000, &passed, 1);
  EXPECT_FALSE(at_once.spend());
  EXPECT_EQ(at_once.spent(), 1);
  SearchBudget in_a_node(1000000, &passed);
  EXPECT_TRUE(in_a_node.spend());
  EXPECT_FALSE(in_a_node.look_at_clock());
  EXPECT_FALSE(in_a_node.spend());
}

TEST(DenseReductions, KeepTheOptimum) {
  DenseReductions reductions;
  int decided = 0, vertices = 0;
  for_random_graphs(1000, [&](const ConflictGraph& graph, int index) {
    DenseGraph dense = dense_graph_of(graph);
    reductions.reduce(dense);
    // The kernel by brute force, on a graph of its own.
    std::vector<std::int32_t> left;
    bits::for_each(reductions.left(), dense.words(),
                   [&](std::size_t v) { left.push_back(static_cast<std::int32_t>(v)); });
    std::vector<std::int64_t> weights;
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;
    for (std::size_t a = 0; a < left.size(); ++a) {
      weights.push_back(dense.weight(left[a]));
      EXPECT_GT(weights.back(), 0);
      for (std::size_t b = 0; b < a; ++b)
        if (dense.has_edge(left[a], left[b])) edges.emplace_back(a, b);
    }
    const ConflictGraph kernel = hexpipe::testing::make_graph(weights, edges);
    EXPECT_EQ(brute_force_weight(kernel) + reductions.offset(), brute_force_weight(graph)) << "graph " << index;
    decided += graph.vertex_count() - kernel.vertex_count();
    vertices += graph.vertex_count();
  });
  EXPECT_GT(decided, vertices / 2);
}

TEST(ExactSolver, AgreesWithBruteForceFromAnyStart) {
  ExactSolver solver;
  Random random(5);
  for_random_graphs(1500, [&](const ConflictGraph& graph, int index) {
    // An arbitrary start, which need not be maximal.
    std::vector<bits::Word> chosen(bits::words_for(graph.weights.size()));
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
      const auto in_set = [&](std::int32_t u) { return bits::test(chosen.data(), u); };
      if (random.below(2) == 0 && std::ranges::none_of(graph.neighbours_of(v), in_set)) bits::insert(chosen.data(), v);
    }
    DenseGraph dense = dense_graph_of(graph);
    SearchBudget budget;
    ASSERT_TRUE(solver.solve(dense, chosen, budget));
    EXPECT_EQ(checked_weight(graph, chosen), brute_force_weight(graph)) << "graph " << index;
  });
}

TEST(ExactSolver, NeverReturnsLessThanItGot) {
  ExactSolver solver;
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(60, 0.15, 1000, random);
    std::vector<bits::Word> chosen(bits::words_for(graph.weights.size()));
    std::int64_t weight = 0;
    for (const std::int64_t nodes : {0, 1, 2, 5, 20, 100000}) {
      DenseGraph dense = dense_graph_of(graph);
      SearchBudget budget(nodes);
      const bool complete = solver.solve(dense, chosen, budget);
      const std::int64_t now = checked_weight(graph, chosen);
      EXPECT_GE(now, weight) << "graph " << i;
      EXPECT_FALSE(complete && nodes == 0);
      weight = now;
    }
  }
}

class BranchAndReduceTest : public ::testing::TestWithParam<std::pair<std::string, ExactAlgorithm>> {
 protected:
  BranchAndReduce solver(std::int32_t small) const { return {relaxation_of(GetParam().second), never_, small}; }
  const Deadline never_;
};

std::vector<std::pair<std::string, ExactAlgorithm>> with_reductions() {
  std::vector<std::pair<std::string, ExactAlgorithm>> algorithms;
  for (const auto& [name, algorithm] : exact_algorithms())
    if (name.starts_with("branch-and-")) algorithms.emplace_back(name, algorithm);
  return algorithms;
}

INSTANTIATE_TEST_SUITE_P(Each, BranchAndReduceTest, ::testing::ValuesIn(with_reductions()), [](const auto& algorithm) {
  std::string name = algorithm.param.first;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(BranchAndReduceTest, AgreesWithBruteForceFromAnyBound) {
  for_random_graphs(1000, [&](const ConflictGraph& graph, int index) {
    const std::int64_t expected = brute_force_weight(graph);
    for (const std::int32_t small : {0, 6, 100}) {
      BranchAndReduce solver = this->solver(small);
      const auto found = solver.solve(graph, expected - 1);
      ASSERT_TRUE(found) << "graph " << index;
      EXPECT_NO_THROW(validate(*found, graph, "found"));
      EXPECT_EQ(total_weight(*found, graph), expected) << "graph " << index;
      EXPECT_GE(solver.bound(), expected);
      EXPECT_FALSE(solver.solve(graph, expected)) << "nothing is heavier, graph " << index;
      EXPECT_TRUE(solver.complete());
    }
  });
}

TEST_P(BranchAndReduceTest, BranchesWhereReductionsEnd) {
  Random random(9);
  std::int64_t nodes = 0;
  for (int i = 0; i < 4; ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(60, 0.1, 1000, random);
    BranchAndReduce small = solver(100), branching = solver(20);
    const auto expected = small.solve(graph, 0), found = branching.solve(graph, 0);
    ASSERT_TRUE(expected && found) << "graph " << i;
    EXPECT_EQ(total_weight(*found, graph), total_weight(*expected, graph)) << "graph " << i;
    nodes += branching.nodes();
  }
  EXPECT_GT(nodes, 4);
  const Deadline passed(0.0);
  BranchAndReduce stopped(relaxation_of(GetParam().second), passed);
  EXPECT_FALSE(stopped.solve(hexpipe::testing::random_graph(70, 0.1, 1000, random), 0));
  EXPECT_FALSE(stopped.complete());
}

// Nearly equal weights leave the reduced costs and the bounds of components no room: one that is decided too much is
// missed. Two components share what is needed.
TEST_P(BranchAndReduceTest, MissesNothingThatIsHeavierByOne) {
  Random random(21);
  for (int i = 0; i < 3; ++i) {
    const std::int32_t half = 48;
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;
    for (std::int32_t a = 0; a < 2 * half; ++a)
      for (std::int32_t b = a + 1; b < (a < half ? half : 2 * half); ++b)
        if (random.uniform() < 0.12) edges.emplace_back(a, b);
    std::vector<std::int64_t> weights = hexpipe::testing::random_weights(2 * half, 2, random);
    for (std::int64_t& weight : weights) weight += 10;
    const ConflictGraph graph = hexpipe::testing::make_graph(weights, edges);
    BranchAndReduce small = solver(100), branching = solver(10);
    const auto expected = small.solve(graph, 0);
    const std::int64_t optimum = total_weight(*expected, graph);
    const auto found = branching.solve(graph, optimum - 1);
    ASSERT_TRUE(found) << "graph " << i;
    EXPECT_EQ(total_weight(*found, graph), optimum) << "graph " << i;
    EXPECT_FALSE(branching.solve(graph, optimum)) << "graph " << i;
  }
}

// Time runs out in the reductions or in the search on bits behind them, which has seen some sets alone.
TEST_P(BranchAndReduceTest, ProvesNothingThatItHadNoTimeFor) {
  Random random(22);
  const ConflictGraph graph = hexpipe::testing::random_graph(250, 0.08, 1000, random);
  const LnsResult known = improve_by_lns(graph, {}, {.iterations = 60, .annealed_fragment = 300}, never_);
  for (const double seconds : {1e-4, 2e-4, 5e-4, 1e-3, 2e-3}) {
    const Deadline soon(seconds);
    BranchAndReduce solver(relaxation_of(GetParam().second), soon, 250);
    const auto found = solver.solve(graph, 0);
    EXPECT_FALSE(solver.complete()) << seconds;
    EXPECT_GE(solver.bound(), known.weight) << seconds;
    if (found) {
      EXPECT_NO_THROW(validate(*found, graph, "found")) << seconds;
    }
  }
}

TEST(ExactSolver, SolvesTheExtremes) {
  ExactSolver solver;
  const auto solve = [&](const ConflictGraph& graph) {
    std::vector<bits::Word> chosen(bits::words_for(graph.weights.size()));
    DenseGraph dense = dense_graph_of(graph);
    SearchBudget budget;
    EXPECT_TRUE(solver.solve(dense, chosen, budget));
    return checked_weight(graph, chosen);
  };
  EXPECT_EQ(solve(ConflictGraph{}), 0);
  EXPECT_EQ(solve(hexpipe::testing::make_graph({7}, {})), 7);
  EXPECT_EQ(solve(hexpipe::testing::make_graph({0, 0}, {{0, 1}})), 0);
  Random random(8);
  EXPECT_EQ(solve(hexpipe::testing::random_graph(100, 1.0, 0, random)), 0);
  std::vector<std::int64_t> huge(65, (std::int64_t{1} << 62) / 65);
  EXPECT_EQ(solve(hexpipe::testing::make_graph(huge, {})), 65 * huge[0]);
}

}  // namespace
}  // namespace hexpipe
