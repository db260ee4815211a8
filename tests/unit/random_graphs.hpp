#pragma once
// Small conflict graphs for tests, their heaviest independent sets by trying everything, and lists of candidates.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/run/deadline.hpp"
#include "common/run/random.hpp"

namespace hexpipe::testing {
using namespace graph;

inline const Deadline no_deadline;

inline ConflictGraph make_graph(std::vector<std::int64_t> weights,
                                const std::vector<std::pair<std::int32_t, std::int32_t>>& edges) {
  std::vector<std::set<std::int32_t>> lists(weights.size());
  for (const auto& [a, b] : edges) lists[a].insert(b), lists[b].insert(a);
  ConflictGraph graph;
  graph.weights = std::move(weights);
  for (const auto& list : lists) {
    graph.neighbours.insert(graph.neighbours.end(), list.begin(), list.end());
    graph.offsets.push_back(static_cast<std::int64_t>(graph.neighbours.size()));
  }
  return graph;
}

// A candidate of quality 0.5.
inline void add_candidate(Candidates& to, CellKind kind, std::vector<Vertex> corners,
                          const std::vector<std::int32_t>& tets, double volume = 2) {
  corners.resize(8, no_index);
  std::copy(corners.begin(), corners.end(), to.vertices.emplace_back().begin());
  to.kind.push_back(kind);
  to.quality.push_back(0.5);
  to.volume.push_back(volume);
  for (const std::int32_t t : tets) to.tets.emplace_back(t);
  to.tet_offsets.push_back(static_cast<std::int64_t>(to.tets.size()));
  to.boundary_tet_offsets.push_back(0);
}

inline std::vector<std::int64_t> random_weights(std::int32_t vertices, std::int64_t heaviest, Random& random) {
  std::vector<std::int64_t> weights(vertices);
  for (auto& weight : weights) weight = static_cast<std::int64_t>(random.below(heaviest + 1));
  return weights;
}

// The search's own state is right, and its best set is one of the graph's, with the weight that it tells.
template <class Search>
void check_consistency(const Search& search, const ConflictGraph& graph) {
  ASSERT_TRUE(search.check());
  const IndependentSet set = search.best();
  ASSERT_NO_THROW(validate(set, graph, "best"));
  EXPECT_EQ(total_weight(set, graph), search.best_weight());
}

// Every edge with the same probability; weights from 0 to `heaviest`, a small one for many ties.
inline ConflictGraph random_graph(std::int32_t vertices, double density, std::int64_t heaviest, Random& random) {
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::int32_t a = 0; a < vertices; ++a)
    for (std::int32_t b = a + 1; b < vertices; ++b)
      if (random.uniform() < density) edges.emplace_back(a, b);
  return make_graph(random_weights(vertices, heaviest, random), edges);
}

// Vertices are sets of 2 to 4 neighbouring cells on a ring of `cells`, in conflict where they share one: cliques as in
// conflict graphs of meshes, long enough for neighbourhoods to be local.
inline ConflictGraph random_clique_graph(std::int32_t vertices, std::int32_t cells, std::int64_t heaviest,
                                         Random& random) {
  std::vector<std::set<std::uint64_t>> parts(vertices);
  for (auto& part : parts) {
    const std::uint64_t place = random.below(cells);
    for (std::uint64_t left = 2 + random.below(3); left > 0; --left) part.insert((place + random.below(6)) % cells);
  }
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::int32_t a = 0; a < vertices; ++a)
    for (std::int32_t b = a + 1; b < vertices; ++b)
      if (std::ranges::any_of(parts[a], [&](std::uint64_t cell) { return parts[b].contains(cell); }))
        edges.emplace_back(a, b);
  return make_graph(random_weights(vertices, heaviest, random), edges);
}

inline std::int64_t brute_force_weight(const ConflictGraph& graph, std::int32_t from, std::uint64_t excluded) {
  for (; from < graph.vertex_count() && (excluded >> from & 1) != 0; ++from) {
  }
  if (from == graph.vertex_count()) return 0;
  const std::int64_t without = brute_force_weight(graph, from + 1, excluded);
  for (const std::int32_t u : graph.neighbours_of(from)) excluded |= std::uint64_t{1} << u;
  return std::max(without, graph.weights[from] + brute_force_weight(graph, from + 1, excluded));
}

// For up to 64 vertices; quick up to some 25.
inline std::int64_t brute_force_weight(const ConflictGraph& graph) {
  return brute_force_weight(graph, 0, 0);
}

// The same weights, and an edge where the graph has none.
inline ConflictGraph complement_of(const ConflictGraph& graph) {
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::int32_t a = 0; a < graph.vertex_count(); ++a)
    for (std::int32_t b = a + 1; b < graph.vertex_count(); ++b)
      if (!graph.has_edge(a, b)) edges.emplace_back(a, b);
  return make_graph(graph.weights, edges);
}

}  // namespace hexpipe::testing
