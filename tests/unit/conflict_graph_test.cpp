#include "common/graph/conflict_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "common/run/error.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace graph;
namespace {

using hexpipe::testing::make_graph;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

ConflictGraph path_of_three() {
  return make_graph({5, 7, 5}, {{0, 1}, {1, 2}});
}

void expect_rejected(const ConflictGraph& graph, const char* message) {
  EXPECT_THAT([&] { validate(graph, "test"); }, ThrowsMessage<DataError>(HasSubstr(message)));
}

TEST(ConflictGraph, AcceptsWhatIsWellFormed) {
  EXPECT_NO_THROW(validate(ConflictGraph{}, "test"));
  EXPECT_NO_THROW(validate(make_graph({0}, {}), "test"));
  EXPECT_NO_THROW(validate(path_of_three(), "test"));
  Random random(1);
  for (int i = 0; i < 50; ++i) EXPECT_NO_THROW(validate(hexpipe::testing::random_graph(30, 0.3, 9, random), "test"));
}

TEST(ConflictGraph, FindsEdges) {
  const ConflictGraph graph = path_of_three();
  EXPECT_TRUE(graph.has_edge(0, 1));
  EXPECT_TRUE(graph.has_edge(1, 0));
  EXPECT_FALSE(graph.has_edge(0, 2));
  EXPECT_EQ(graph.edge_count(), 2);
  EXPECT_EQ(graph.degree(1), 2);
}

TEST(ConflictGraph, RejectsArraysThatDisagree) {
  ConflictGraph graph = path_of_three();
  graph.offsets.pop_back();
  expect_rejected(graph, "offsets");
  graph = path_of_three();
  graph.offsets.clear();
  expect_rejected(graph, "offsets");
  graph = path_of_three();
  graph.offsets[0] = 1;
  expect_rejected(graph, "first offset");
  graph = path_of_three();
  graph.offsets[1] = 4;
  expect_rejected(graph, "ascending offsets");
  graph = path_of_three();
  graph.neighbours.push_back(0);
  expect_rejected(graph, "neighbours by the last offset");
}

TEST(ConflictGraph, RejectsBadWeights) {
  ConflictGraph graph = path_of_three();
  graph.weights[1] = -1;
  expect_rejected(graph, "vertex 1");
  graph.weights = {std::numeric_limits<std::int64_t>::max(), 0, 1};
  expect_rejected(graph, "fits 64 bits");
  graph.weights = {std::numeric_limits<std::int64_t>::max(), 0, 0};
  EXPECT_NO_THROW(validate(graph, "test"));
}

TEST(ConflictGraph, RejectsBadNeighbours) {
  ConflictGraph graph = path_of_three();
  graph.neighbours[0] = 3;
  expect_rejected(graph, "neighbours below 3");
  graph.neighbours[0] = -1;
  expect_rejected(graph, "neighbours below 3");
  graph.neighbours[0] = 0;
  expect_rejected(graph, "loops");
  graph = path_of_three();
  std::swap(graph.neighbours[1], graph.neighbours[2]);
  expect_rejected(graph, "ascending neighbours");
  graph = path_of_three();
  graph.neighbours[2] = 0;
  expect_rejected(graph, "found 0 after 0");
}

TEST(ConflictGraph, FindsEveryOneSidedEdge) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    ConflictGraph graph = hexpipe::testing::random_graph(12, 0.3, 9, random);
    ASSERT_FALSE(find_one_sided_edge(graph));
    if (graph.neighbours.empty()) continue;
    // Take one direction of one edge away.
    const auto at = static_cast<std::int64_t>(random.below(graph.neighbours.size()));
    std::int32_t from = 0;
    while (graph.offsets[from + 1] <= at) ++from;
    const std::int32_t to = graph.neighbours[at];
    graph.neighbours.erase(graph.neighbours.begin() + at);
    for (std::int32_t v = from; v < graph.vertex_count(); ++v) --graph.offsets[v + 1];
    const auto found = find_one_sided_edge(graph);
    ASSERT_TRUE(found) << "graph " << i;
    EXPECT_EQ(found->from, to) << "graph " << i;
    EXPECT_EQ(found->to, from) << "graph " << i;
  }
}

TEST(IndependentSet, RejectsWhatIsNone) {
  const ConflictGraph graph = path_of_three();
  EXPECT_NO_THROW(validate(IndependentSet{}, graph, "test"));
  EXPECT_NO_THROW(validate(IndependentSet{0, 2}, graph, "test"));
  const auto rejects = [&](const IndependentSet& set, const char* message) {
    EXPECT_THAT([&] { validate(set, graph, "test"); }, ThrowsMessage<DataError>(HasSubstr(message)));
  };
  rejects({0, 1}, "found the neighbours 0 and 1 (counted from 0)");
  rejects({3}, "vertices below 3");
  rejects({-1}, "vertices below 3");
  rejects({2, 0}, "ascending");
  rejects({2, 2}, "ascending");
}

TEST(IndependentSet, Weighs) {
  EXPECT_EQ(total_weight({0, 2}, path_of_three()), 10);
  EXPECT_EQ(total_weight({}, path_of_three()), 0);
}

}  // namespace
}  // namespace hexpipe
