#include "common/graph/conflict_graph.hpp"

#include <algorithm>

namespace hexpipe::graph {

ConflictGraph induced_subgraph(const ConflictGraph& graph, std::span<const std::int32_t> vertices) {
  std::vector<std::int32_t> numbers(graph.weights.size(), no_index);
  for (std::size_t i = 0; i < vertices.size(); ++i) numbers[vertices[i]] = static_cast<std::int32_t>(i);
  ConflictGraph result;
  for (const std::int32_t v : vertices) {
    result.weights.push_back(graph.weights[v]);
    for (const std::int32_t u : graph.neighbours_of(v))
      if (numbers[u] != no_index) result.neighbours.push_back(numbers[u]);
    result.offsets.push_back(static_cast<std::int64_t>(result.neighbours.size()));
  }
  return result;
}

std::vector<std::vector<std::int32_t>> connected_components(const ConflictGraph& graph) {
  std::vector<char> seen(graph.weights.size(), 0);
  std::vector<std::vector<std::int32_t>> components;
  for (std::int32_t first = 0; first < graph.vertex_count(); ++first) {
    if (seen[first] != 0) continue;
    seen[first] = 1;
    std::vector<std::int32_t>& component = components.emplace_back(1, first);
    for (std::size_t next = 0; next < component.size(); ++next)
      for (const std::int32_t u : graph.neighbours_of(component[next]))
        if (seen[u] == 0) {
          seen[u] = 1;
          component.push_back(u);
        }
    std::ranges::sort(component);
  }
  std::ranges::stable_sort(components, {}, [](const auto& component) { return component.size(); });
  return components;
}

}  // namespace hexpipe::graph
