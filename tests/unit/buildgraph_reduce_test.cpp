#include "tools/buildgraph/reduce.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/graph/conflict_graph.hpp"
#include "random_graphs.hpp"

namespace hexpipe {
using namespace buildgraph;
using namespace graph;
namespace {

using hexpipe::testing::brute_force_weight;
using hexpipe::testing::make_graph;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

bool is_dominated(const ConflictGraph& graph, std::int32_t v) {
  return std::ranges::any_of(graph.neighbours_of(v), [&](std::int32_t u) {
    return graph.weights[u] >= graph.weights[v] &&
           std::ranges::all_of(graph.neighbours_of(u), [&](std::int32_t n) { return n == v || graph.has_edge(n, v); });
  });
}

// A graph's vertices as candidates that can be told apart.
Candidates numbered_candidates(const ConflictGraph& graph) {
  Candidates candidates;
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    candidates.vertices.push_back({v, v + 1, v + 2, v + 3, v + 4, -1, -1, -1});
    candidates.kind.push_back(CellKind::pyramid);
    candidates.quality.push_back(v);
    candidates.volume.push_back(2.0 * v);
    for (std::int32_t t = 0; t < v % 3; ++t) candidates.tets.emplace_back(v + t);
    candidates.tet_offsets.push_back(static_cast<std::int64_t>(candidates.tets.size()));
    for (std::int32_t t = 0; t < v % 2; ++t) candidates.boundary_tets.emplace_back(100 + v);
    candidates.boundary_tet_offsets.push_back(static_cast<std::int64_t>(candidates.boundary_tets.size()));
  }
  return candidates;
}

TEST(Domination, KeepsTheHeavierOfFewerConflicts) {
  // A path: the ends have fewer conflicts than the middle.
  EXPECT_THAT(undominated_vertices(make_graph({3, 3, 3}, {{0, 1}, {1, 2}})), ElementsAre(0, 2));
  EXPECT_THAT(undominated_vertices(make_graph({2, 3, 2}, {{0, 1}, {1, 2}})), ElementsAre(0, 1, 2));
  // Equal in all: one stays.
  EXPECT_THAT(undominated_vertices(make_graph({3, 3}, {{0, 1}})), ElementsAre(1));
  EXPECT_THAT(undominated_vertices(make_graph({3, 3, 2}, {{0, 1}, {1, 2}, {0, 2}})), ElementsAre(1));
  // 1 is dominated by 2 only once 4 has dominated 3.
  EXPECT_THAT(undominated_vertices(make_graph({1, 5, 6, 4, 9}, {{0, 1}, {1, 2}, {2, 3}, {3, 4}})),
              ElementsAre(0, 2, 4));
  EXPECT_THAT(undominated_vertices({}), IsEmpty());
}

TEST(Domination, LeavesTheOptimumAndNothingDominated) {
  Random random(21);
  std::int64_t dropped = 0, all = 0;
  for (int i = 0; i < 400; ++i) {
    const auto vertices = static_cast<std::int32_t>(random.below(22));
    const ConflictGraph graph =
        i % 2 == 0 ? hexpipe::testing::random_graph(vertices, random.uniform(), 5, random)
                   : hexpipe::testing::random_clique_graph(vertices, 20, i % 3 == 0 ? 3 : 1000, random);
    ConflictGraph reduced = graph;
    Candidates candidates = numbered_candidates(graph);
    const Candidates before = candidates;
    dropped += reduce(candidates, reduced);
    all += vertices;
    validate(reduced, "test");
    EXPECT_EQ(brute_force_weight(reduced), brute_force_weight(graph)) << "graph " << i;
    ASSERT_EQ(candidates.size(), reduced.weights.size());
    const auto kept = undominated_vertices(graph);
    EXPECT_EQ(candidates, select(before, std::vector<CandidateIndex>(kept.begin(), kept.end())));
    EXPECT_EQ(reduced, induced_subgraph(graph, kept)) << "graph " << i;
    for (std::int32_t v = 0; v < reduced.vertex_count(); ++v) {
      EXPECT_FALSE(is_dominated(reduced, v)) << "graph " << i << ", vertex " << v;
      const auto old = static_cast<std::int32_t>(candidates.quality[v]);
      EXPECT_EQ(candidates.vertices[v], before.vertices[old]);
      EXPECT_TRUE(std::ranges::equal(candidates.interior_tets_of(v), before.interior_tets_of(old)));
      EXPECT_TRUE(std::ranges::equal(candidates.boundary_tets_of(v), before.boundary_tets_of(old)));
    }
  }
  EXPECT_GT(dropped, all / 10);
}

}  // namespace
}  // namespace hexpipe
