#include "common/graph/conflict_graph.hpp"

#include <algorithm>
#include <limits>

#include "common/run/error.hpp"

namespace hexpipe::graph {
namespace {

void check_lengths(const ConflictGraph& graph, const char* source) {
  const std::size_t n = graph.weights.size();
  if (n > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw DataError::at(source, "expected at most {} vertices, found {}", std::numeric_limits<std::int32_t>::max(), n);
  if (graph.offsets.size() != n + 1)
    throw DataError::at(source, "expected {} offsets for {} weights, found {}", n + 1, n, graph.offsets.size());
  if (graph.offsets.front() != 0)
    throw DataError::at(source, "expected the first offset to be 0, found {}", graph.offsets.front());
  for (std::size_t v = 0; v < n; ++v)
    if (graph.offsets[v + 1] < graph.offsets[v])
      throw DataError::at(source, "expected ascending offsets, found {} after {} at vertex {}", graph.offsets[v + 1],
                          graph.offsets[v], v);
  if (static_cast<std::size_t>(graph.offsets.back()) != graph.neighbours.size())
    throw DataError::at(source, "expected {} neighbours by the last offset, found {}", graph.offsets.back(),
                        graph.neighbours.size());
}

void check_weights(const ConflictGraph& graph, const char* source) {
  std::int64_t sum = 0;
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    if (graph.weights[v] < 0)
      throw DataError::at(source, "expected a weight of 0 or more, found {} at vertex {}", graph.weights[v], v);
    if (__builtin_add_overflow(sum, graph.weights[v], &sum))
      throw DataError::at(source, "expected weights whose sum fits 64 bits, found an overflow at vertex {}", v);
  }
}

void check_neighbour_lists(const ConflictGraph& graph, const char* source) {
  const std::int32_t n = graph.vertex_count();
  for (std::int32_t v = 0; v < n; ++v) {
    std::int32_t last = -1;
    for (const std::int32_t u : graph.neighbours_of(v)) {
      if (u < 0 || u >= n) throw DataError::at(source, "expected neighbours below {}, found {} at vertex {}", n, u, v);
      if (u == v) throw DataError::at(source, "expected no loops, found one at vertex {}", v);
      if (u <= last)
        throw DataError::at(source, "expected ascending neighbours without repeats, found {} after {} at vertex {}", u,
                            last, v);
      last = u;
    }
  }
}

}  // namespace

bool ConflictGraph::has_edge(std::int32_t a, std::int32_t b) const {
  if (degree(a) > degree(b)) std::swap(a, b);
  return std::ranges::binary_search(neighbours_of(a), b);
}

std::optional<OneSidedEdge> find_one_sided_edge(const ConflictGraph& graph) {
  const std::int32_t n = graph.vertex_count();
  // Vertices are visited in ascending order, so every vertex sees its lower neighbours confirm their edges in the order
  // of its list. `confirmed` is the place of the next expected one.
  std::vector<std::int64_t> confirmed(graph.offsets.begin(), graph.offsets.end() - 1);
  for (std::int32_t v = 0; v < n; ++v) {
    const std::int64_t end = graph.offsets[v + 1];
    if (confirmed[v] < end && graph.neighbours[confirmed[v]] < v)
      return OneSidedEdge{v, graph.neighbours[confirmed[v]]};
    for (std::int64_t i = confirmed[v]; i < end; ++i) {
      const std::int32_t u = graph.neighbours[i];
      if (confirmed[u] == graph.offsets[u + 1] || graph.neighbours[confirmed[u]] != v) {
        // u expects a lower vertex that did not name it, or does not name v itself.
        const bool skipped = confirmed[u] < graph.offsets[u + 1] && graph.neighbours[confirmed[u]] < v;
        return skipped ? OneSidedEdge{u, graph.neighbours[confirmed[u]]} : OneSidedEdge{v, u};
      }
      ++confirmed[u];
    }
  }
  return std::nullopt;
}

void validate(const ConflictGraph& graph, const char* source) {
  check_lengths(graph, source);
  check_weights(graph, source);
  check_neighbour_lists(graph, source);
  if (const auto edge = find_one_sided_edge(graph))
    throw DataError::at(source, "expected every edge at both ends, found {} beside {} but not {} beside {}", edge->to,
                        edge->from, edge->from, edge->to);
}

void validate(const IndependentSet& set, const ConflictGraph& graph, const char* source) {
  const std::int32_t n = graph.vertex_count();
  std::vector<char> chosen(n, 0);
  std::int32_t last = -1;
  for (const std::int32_t v : set) {
    if (v < 0 || v >= n)
      throw DataError::at(source, "expected vertices below {} (the graph's number of them), found {}", n, v);
    if (v <= last)
      throw DataError::at(source, "expected ascending vertices without repeats, found {} after {}", v, last);
    last = v;
    chosen[v] = 1;
  }
  for (const std::int32_t v : set)
    for (const std::int32_t u : graph.neighbours_of(v))
      if (chosen[u])
        throw DataError::at(source, "expected an independent set, found the neighbours {} and {} (counted from 0)", v,
                            u);
}

std::int64_t total_weight(const IndependentSet& set, const ConflictGraph& graph) {
  std::int64_t sum = 0;
  for (const std::int32_t v : set) sum += graph.weights[v];
  return sum;
}

}  // namespace hexpipe::graph
