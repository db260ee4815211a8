#include "common/mwis/reduce/kernel.hpp"

#include <gtest/gtest.h>

#include "common/mwis/exact/exact_solver.hpp"
#include "random_graphs.hpp"
#include "tests/unit/random_cases.hpp"

namespace hexpipe {
using namespace mwis;
using namespace graph;
using namespace mwis::exact;
using namespace mwis::ground;
using namespace mwis::reduce;
namespace {

using hexpipe::testing::brute_force_weight;

// Every maximal set is worth lifting, the best by brute force most of all.
IndependentSet best_set(const ConflictGraph& graph, std::int64_t weight) {
  for (std::uint64_t subset = 0; subset < std::uint64_t{1} << graph.vertex_count(); ++subset) {
    IndependentSet set;
    bool independent = true;
    for (std::int32_t v = 0; v < graph.vertex_count() && independent; ++v) {
      if ((subset >> v & 1) == 0) continue;
      for (const std::int32_t u : graph.neighbours_of(v))
        independent = independent && (u > v || (subset >> u & 1) == 0);
      set.push_back(v);
    }
    if (independent && total_weight(set, graph) == weight) return set;
  }
  return {};
}

class KernelTest : public ::testing::TestWithParam<ReductionEffort> {};

INSTANTIATE_TEST_SUITE_P(Effort, KernelTest,
                         ::testing::Values(ReductionEffort::quick, ReductionEffort::worth, ReductionEffort::thorough),
                         [](const auto& effort) {
                           return effort.param == ReductionEffort::quick   ? "Quick"
                                  : effort.param == ReductionEffort::worth ? "Worth"
                                                                           : "Thorough";
                         });

TEST_P(KernelTest, KeepsTheOptimumAndLiftsIt) {
  Random random(1);
  int decided = 0, vertices = 0;
  for (int i = 0; i < hexpipe::testing::random_cases(1500); ++i) {
    const auto count = static_cast<std::int32_t>(random.below(24));
    const std::int64_t heaviest = i % 3 == 0 ? 3 : 1000;
    const ConflictGraph graph = i % 2 == 0 ? hexpipe::testing::random_graph(count, random.uniform(), heaviest, random)
                                           : hexpipe::testing::random_clique_graph(count, 20, heaviest, random);
    const Kernel kernel(graph, Deadline(), GetParam());
    ASSERT_NO_THROW(validate(kernel.graph(), "kernel")) << "graph " << i;
    const std::int64_t optimum = brute_force_weight(graph);
    const std::int64_t of_kernel = brute_force_weight(kernel.graph());
    ASSERT_EQ(of_kernel + kernel.offset(), optimum) << "graph " << i;
    decided += graph.vertex_count() - kernel.graph().vertex_count();
    vertices += graph.vertex_count();
    if (kernel.graph().vertex_count() > 14) continue;
    const IndependentSet lifted = kernel.lift(best_set(kernel.graph(), of_kernel));
    ASSERT_NO_THROW(validate(lifted, graph, "lifted")) << "graph " << i;
    EXPECT_EQ(total_weight(lifted, graph), optimum) << "graph " << i;
  }
  EXPECT_GT(decided, vertices / 2);
}

// As lns-mpi does on the blocks of a graph, none of which sees the others.
TEST(ReducerTest, HalvesThatAreReducedApartKeepTheOptimumTogether) {
  Random random(3);
  int decided = 0;
  for (int i = 0; i < hexpipe::testing::random_cases(1500); ++i) {
    const auto count = static_cast<std::int32_t>(2 + random.below(22)), middle = count / 2;
    const ConflictGraph graph = i % 2 == 0 ? hexpipe::testing::random_graph(count, 0.4 * random.uniform(), 20, random)
                                           : hexpipe::testing::random_clique_graph(count, count / 2, 20, random);
    std::vector<char> left(static_cast<std::size_t>(count), 1);
    std::int64_t offset = 0;
    for (const std::int32_t first : {0, middle}) {
      const std::int32_t last = first == 0 ? middle : count;
      ConflictGraph half;
      std::vector<char> incomplete;
      for (std::int32_t v = first; v < last; ++v) {
        half.weights.push_back(graph.weights[v]);
        incomplete.push_back(0);
        for (const std::int32_t u : graph.neighbours_of(v))
          if (u >= first && u < last)
            half.neighbours.push_back(u - first);
          else
            incomplete.back() = 1;
        half.offsets.push_back(static_cast<std::int64_t>(half.neighbours.size()));
      }
      ReductionLog log;
      Reducer reducer(half, log, incomplete);
      offset += reducer.run(ReductionEffort::quick, Deadline());
      for (std::int32_t v = first; v < last; ++v) left[v] = reducer.graph().alive(v - first) ? 1 : 0;
    }
    std::vector<std::int32_t> numbers(static_cast<std::size_t>(count), -1);
    ConflictGraph rest;
    for (std::int32_t v = 0; v < count; ++v)
      if (left[v] != 0) numbers[v] = rest.vertex_count(), rest.weights.push_back(graph.weights[v]);
    for (std::int32_t v = 0; v < count; ++v) {
      if (left[v] == 0) continue;
      for (const std::int32_t u : graph.neighbours_of(v))
        if (left[u] != 0) rest.neighbours.push_back(numbers[u]);
      rest.offsets.push_back(static_cast<std::int64_t>(rest.neighbours.size()));
    }
    ASSERT_EQ(brute_force_weight(rest) + offset, brute_force_weight(graph)) << "graph " << i;
    decided += count - rest.vertex_count();
  }
  EXPECT_GT(decided, hexpipe::testing::random_cases(1500));
}

TEST_P(KernelTest, LiftsAnySetToAMaximalOneAndProjectsBack) {
  Random random(2);
  for (int i = 0; i < hexpipe::testing::random_cases(12); ++i) {
    const ConflictGraph graph = hexpipe::testing::random_graph(80, 0.1, 100, random);
    const Kernel kernel(graph, Deadline(), GetParam());
    for (const IndependentSet& set :
         {IndependentSet{}, kernel.graph().vertex_count() > 0 ? IndependentSet{0} : IndependentSet{}}) {
      const IndependentSet lifted = kernel.lift(set);
      ASSERT_NO_THROW(validate(lifted, graph, "lifted"));
      EXPECT_GE(total_weight(lifted, graph), total_weight(set, kernel.graph()) + kernel.offset());
      const IndependentSet projected = kernel.project(lifted);
      ASSERT_NO_THROW(validate(projected, kernel.graph(), "projected"));
    }
  }
}

// A graph too large for brute force, where folds that add vertices and are taken back matter: the optimum is that of
// the exact solver, and every solution on the way is one.
TEST(Kernel, IsExactOnLargerGraphsToo) {
  Random random(5);
  ExactSolver solver;
  const auto optimum = [&](const ConflictGraph& graph, IndependentSet& best) {
    DenseGraph dense = dense_graph_of(graph);
    std::vector<bits::Word> chosen(dense.words(), 0);
    SearchBudget budget;
    EXPECT_TRUE(solver.solve(dense, chosen, budget));
    bits::for_each(chosen.data(), chosen.size(), [&](std::size_t v) { best.push_back(static_cast<std::int32_t>(v)); });
    return total_weight(best, graph);
  };
  std::int32_t quick_left = 0, left = 0;
  for (int i = 0; i < 16; ++i) {
    const auto vertices = 50 + static_cast<std::int32_t>(random.below(150));
    const ConflictGraph graph = i % 2 == 0 ? hexpipe::testing::random_clique_graph(vertices, 100, 1000, random)
                                           : hexpipe::testing::random_graph(vertices, 0.05, 1000, random);
    const Kernel quick(graph, Deadline());
    const Kernel kernel(graph, Deadline(), ReductionEffort::thorough);
    ASSERT_NO_THROW(validate(kernel.graph(), "kernel")) << "graph " << i;
    quick_left += quick.graph().vertex_count();
    left += kernel.graph().vertex_count();
    IndependentSet best, best_of_kernel;
    const std::int64_t expected = optimum(graph, best);
    ASSERT_EQ(optimum(kernel.graph(), best_of_kernel) + kernel.offset(), expected) << "graph " << i;
    const IndependentSet lifted = kernel.lift(best_of_kernel);
    ASSERT_NO_THROW(validate(lifted, graph, "lifted")) << "graph " << i;
    EXPECT_EQ(total_weight(lifted, graph), expected) << "graph " << i;
    const IndependentSet projected = kernel.project(best);
    ASSERT_NO_THROW(validate(projected, kernel.graph(), "projected")) << "graph " << i;
    EXPECT_LE(total_weight(projected, kernel.graph()) + kernel.offset(), expected) << "graph " << i;
  }
  EXPECT_LT(3 * left, 2 * quick_left);
}

TEST(Kernel, DecidesTreesAndIntervalsAlone) {
  // Every tree and every interval graph has a simplicial vertex, as long as anything is left.
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;
    for (std::int32_t v = 1; v < 500; ++v) edges.emplace_back(v, static_cast<std::int32_t>(random.below(v)));
    const ConflictGraph tree = hexpipe::testing::make_graph(hexpipe::testing::random_weights(500, 1000, random), edges);
    const Kernel kernel(tree, Deadline(), ReductionEffort::thorough);
    EXPECT_EQ(kernel.graph().vertex_count(), 0);
    EXPECT_EQ(total_weight(kernel.lift({}), tree), kernel.offset());
  }
}

// A list that names a vertex that was gone before the mark is copied behind it when it is cleaned up, and comes back
// as it was.
TEST(ReducibleGraph, NamesNothingThatIsGoneAfterARollback) {
  ReducibleGraph graph(hexpipe::testing::make_graph({1, 1, 1}, {{0, 1}, {1, 2}}));
  graph.remove(0);
  graph.mark();
  EXPECT_EQ(graph.neighbours_of(1).size(), 1u);
  graph.rollback();
  EXPECT_EQ(graph.neighbours_of(1).size(), 1u);
  std::vector<std::int32_t> vertices;
  EXPECT_EQ(graph.compress(vertices).edge_count(), 1);
}

TEST(Kernel, StopsAtItsDeadline) {
  Random random(4);
  const ConflictGraph graph = hexpipe::testing::random_clique_graph(2000, 3000, 1000, random);
  const Kernel none(graph, Deadline(0));
  EXPECT_GT(none.graph().vertex_count(), 1000);
  EXPECT_NO_THROW(validate(none.lift({}), graph, "lifted"));
}

}  // namespace
}  // namespace hexpipe
