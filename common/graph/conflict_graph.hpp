#pragma once
// The conflict graph: one vertex per candidate cell, and an edge between two cells that cannot be chosen together.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::graph {

struct ConflictGraph {
  std::vector<std::int64_t> offsets{0};  // vertices + 1
  std::vector<std::int32_t> neighbours;  // both directions, ascending within a vertex
  std::vector<std::int64_t> weights;     // one per vertex, 0 or more

  std::int32_t vertex_count() const { return static_cast<std::int32_t>(weights.size()); }
  std::int64_t edge_count() const { return static_cast<std::int64_t>(neighbours.size()) / 2; }
  std::int64_t degree(std::int32_t v) const { return offsets[v + 1] - offsets[v]; }
  std::span<const std::int32_t> neighbours_of(std::int32_t v) const {
    return std::span(neighbours).subspan(offsets[v], degree(v));
  }
  bool has_edge(std::int32_t a, std::int32_t b) const;
  bool operator==(const ConflictGraph&) const = default;
};

// An independent set: vertices of a conflict graph, ascending.
using IndependentSet = std::vector<std::int32_t>;

// An edge that only one of its ends names: `from` has `to` among its neighbours, but not the other way round.
struct OneSidedEdge {
  std::int32_t from, to;
};

// For lists that ascend, are in range and have no loops. O(vertices + edges).
std::optional<OneSidedEdge> find_one_sided_edge(const ConflictGraph& graph);

// Throws DataError naming `source` when arrays disagree in length, offsets do not ascend, neighbours are out of range,
// unsorted, repeated, loops or one-sided, weights are negative, or their sum does not fit 64 bits.
void validate(const ConflictGraph& graph, const char* source);

// Throws DataError naming `source` when `set` is unsorted, repeats a vertex, exceeds the graph's vertices or holds an
// edge.
void validate(const IndependentSet& set, const ConflictGraph& graph, const char* source);

std::int64_t total_weight(const IndependentSet& set, const ConflictGraph& graph);

// The subgraph that `vertices` induce. They ascend, and are renumbered in this order.
ConflictGraph induced_subgraph(const ConflictGraph& graph, std::span<const std::int32_t> vertices);

// The vertices of each connected component, ascending; the smallest component first.
std::vector<std::vector<std::int32_t>> connected_components(const ConflictGraph& graph);

}  // namespace hexpipe::graph
