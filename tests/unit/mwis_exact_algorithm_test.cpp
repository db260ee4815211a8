#include "common/mwis/exact_algorithm.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/run/error.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace graph;
using namespace mwis;
using namespace mwis::exact;
namespace {

using hexpipe::testing::brute_force_weight;
using hexpipe::testing::no_deadline;

ConflictGraph nth_graph(int i, Random& random) {
  const auto vertices = static_cast<std::int32_t>(random.below(22));
  const std::int64_t heaviest = i % 3 == 0 ? 3 : 1000;
  return i % 2 == 0 ? hexpipe::testing::random_graph(vertices, random.uniform(), heaviest, random)
                    : hexpipe::testing::random_clique_graph(vertices, 30, heaviest, random);
}

class ExactAlgorithmTest : public ::testing::TestWithParam<std::pair<const std::string, ExactAlgorithm>> {
 protected:
  ExactResult solve(const ConflictGraph& graph, std::int64_t weight, const Deadline& deadline = no_deadline) const {
    return solve_exactly(graph, weight, GetParam().second, deadline);
  }
};

INSTANTIATE_TEST_SUITE_P(Each, ExactAlgorithmTest, ::testing::ValuesIn(exact_algorithms()), [](const auto& algorithm) {
  std::string name = algorithm.param.first;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST_P(ExactAlgorithmTest, AgreesWithBruteForceFromAnyWeight) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const ConflictGraph graph = nth_graph(i, random);
    const std::int64_t optimum = brute_force_weight(graph);
    const ExactResult found = solve(graph, i % 4 == 0 ? optimum - 1 : -1);
    ASSERT_TRUE(found.complete && found.better) << "graph " << i;
    EXPECT_NO_THROW(validate(*found.better, graph, "found")) << "graph " << i;
    EXPECT_EQ(total_weight(*found.better, graph), optimum) << "graph " << i;
    EXPECT_GE(found.bound, optimum) << "graph " << i;
    const ExactResult none = solve(graph, optimum);
    EXPECT_TRUE(none.complete && !none.better) << "graph " << i;
    EXPECT_GE(none.bound, optimum) << "graph " << i;
  }
}

TEST_P(ExactAlgorithmTest, SaysWhenTheTimeWasTooShort) {
  Random random(2);
  const ConflictGraph graph = hexpipe::testing::random_graph(300, 0.05, 1000, random);
  const ExactResult stopped = solve(graph, -1, Deadline(0));
  EXPECT_FALSE(stopped.complete);
  EXPECT_GE(stopped.bound, 0);
}

// Prices are those of a simplex method in floating point, so that nodes are not quite the same.
TEST(ExactAlgorithms, ProveHugeWeights) {
  Random random(5);
  ConflictGraph graph = hexpipe::testing::random_graph(130, 0.1, 1000, random);
  const ExactAlgorithm algorithm = exact_algorithms().at(default_exact_algorithm());
  const ExactResult usual = solve_exactly(graph, -1, algorithm, no_deadline);
  const std::int64_t optimum = total_weight(*usual.better, graph);
  constexpr int factor_bits = 46;  // 130 * 1000 before
  for (std::int64_t& weight : graph.weights) weight <<= factor_bits;
  const ExactResult huge = solve_exactly(graph, -1, algorithm, Deadline(100));
  ASSERT_TRUE(huge.complete && huge.better);
  EXPECT_EQ(total_weight(*huge.better, graph), optimum << factor_bits);
  EXPECT_LE(huge.nodes, 2 * usual.nodes);
}

// Up to the sum that clique-lp takes: its prices are then whole numbers of half a weight, and their sums just fit.
TEST(ExactAlgorithms, CliqueLpHasRoomForItsLargestWeights) {
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const auto vertices = static_cast<std::int32_t>(4 + random.below(14));
    const std::int64_t heaviest = ((std::int64_t{1} << 58) - 1) / vertices;
    ConflictGraph graph = hexpipe::testing::random_graph(vertices, 0.4, 3, random);
    for (std::int64_t& weight : graph.weights) weight = heaviest - weight;
    const ExactResult result = solve_exactly(graph, 0, ExactAlgorithm::clique_lp, no_deadline);
    ASSERT_TRUE(result.complete && result.better) << "graph " << i;
    EXPECT_EQ(total_weight(*result.better, graph), brute_force_weight(graph)) << "graph " << i;
  }
}

TEST(ExactAlgorithms, LookAtTheClockInEveryNodeThatTakesLong) {
  Random random(6);
  const ConflictGraph graph = hexpipe::testing::random_graph(300, 0.05, 1000, random);
  EXPECT_LE(solve_exactly(graph, -1, ExactAlgorithm::clique_lp, Deadline(0)).nodes, 1);
}

// Larger than brute force takes, and too large for what branch and reduce leaves to branch and bound at once.
TEST(ExactAlgorithms, AgreeOnLargerGraphs) {
  Random random(3);
  for (int i = 0; i < 12; ++i) {
    const bool small = i < 8;
    const std::int32_t vertices = small ? 40 : 90;
    const ConflictGraph graph =
        i % 2 == 0 ? hexpipe::testing::random_graph(vertices, small ? 0.2 : 0.12, 1000, random)
                   : hexpipe::testing::random_clique_graph(small ? vertices : 200, vertices, 100, random);
    std::int64_t optimum = -1;
    for (const auto& [name, algorithm] : exact_algorithms()) {
      if (!small && (name == "complete-search" || name == "clique-partition")) continue;  // would take days
      const ExactResult result = solve_exactly(graph, -1, algorithm, no_deadline);
      ASSERT_TRUE(result.complete && result.better) << name << ", graph " << i;
      EXPECT_NO_THROW(validate(*result.better, graph, "found")) << name << ", graph " << i;
      if (optimum < 0) optimum = total_weight(*result.better, graph);
      EXPECT_EQ(total_weight(*result.better, graph), optimum) << name << ", graph " << i;
    }
  }
}

// As the cliques of brock200_4, whose relaxation leaves a third of the weight open.
TEST(ExactAlgorithms, ProveDenseGraphsInAMoment) {
  Random random(8);
  for (const double share : {0.2, 0.35}) {
    const ConflictGraph graph = hexpipe::testing::random_graph(200, share, 200, random);
    const ExactResult expected = solve_exactly(graph, -1, ExactAlgorithm::clique_cover, no_deadline);
    for (const char* name : {"branch-and-reduce", "branch-and-cut"}) {
      if (!exact_algorithms().contains(name)) continue;
      const ExactResult result = solve_exactly(graph, -1, exact_algorithms().at(name), Deadline(20));
      ASSERT_TRUE(result.complete && result.better) << name << ", share " << share;
      EXPECT_EQ(total_weight(*result.better, graph), total_weight(*expected.better, graph)) << name;
    }
  }
}

TEST(ExactAlgorithms, RefuseWhatTheyCannotHold) {
  ConflictGraph large;
  large.weights.assign(5000, 1);
  large.offsets.assign(5001, 0);
  const ConflictGraph heavy = hexpipe::testing::make_graph({std::int64_t{1} << 60, 1}, {{0, 1}});
  for (const auto& [name, algorithm] : exact_algorithms()) {
    if (name.starts_with("branch-and-")) {
      EXPECT_NO_THROW(expect_room_for(algorithm, large)) << name;
      EXPECT_EQ(solve_exactly(large, -1, algorithm, no_deadline).bound, 5000) << name;
    } else {
      EXPECT_THROW(expect_room_for(algorithm, large), DataError) << name;
      EXPECT_THROW(solve_exactly(large, -1, algorithm, no_deadline), DataError) << name;
    }
    if (name == "clique-lp") {
      EXPECT_THROW(solve_exactly(heavy, -1, algorithm, no_deadline), DataError);
    } else {
      EXPECT_EQ(solve_exactly(heavy, -1, algorithm, no_deadline).bound, heavy.weights[0]) << name;
    }
  }
}

}  // namespace
}  // namespace hexpipe
