#include "common/graph/conflict_graph.hpp"

#include <algorithm>
#include <ranges>

#include "common/mesh/joined_sets.hpp"

namespace hexpipe::graph {

ConflictGraph induced_subgraph(const ConflictGraph& graph, std::span<const std::int32_t> vertices) {
  std::vector<std::int32_t> numbers(graph.weights.size(), no_index);
  for (std::size_t i = 0; i < vertices.size(); ++i) numbers[vertices[i]] = static_cast<std::int32_t>(i);
  ConflictGraph result;
  result.weights.reserve(vertices.size());
  result.offsets.reserve(vertices.size() + 1);
  for (const std::int32_t v : vertices) {
    result.weights.push_back(graph.weights[v]);
    for (const std::int32_t u : graph.neighbours_of(v))
      if (numbers[u] != no_index) result.neighbours.push_back(numbers[u]);
    result.offsets.push_back(static_cast<std::int64_t>(result.neighbours.size()));
  }
  return result;
}

// A few neighbours of each vertex join nearly all of a component, so most edges of the largest one are never looked at
// (Sutton, Ben-Nun, Barak 2018).
std::vector<std::vector<std::int32_t>> connected_components(const ConflictGraph& graph) {
  if (graph.vertex_count() == 0) return {};
  constexpr std::size_t looked_at_first = 2;
  JoinedSets sets(graph.weights.size());
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    for (const std::int32_t u : graph.neighbours_of(v) | std::views::take(looked_at_first)) sets.join(v, u);
  std::vector<std::int32_t> sizes(graph.weights.size(), 0);
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) ++sizes[sets.of(v)];
  const auto largest = static_cast<std::int32_t>(std::ranges::max_element(sizes) - sizes.begin());
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    if (sets.of(v) == largest) continue;
    for (const std::int32_t u : graph.neighbours_of(v)) sets.join(v, u);
  }
  std::vector<std::int32_t> number(graph.weights.size(), no_index);
  std::vector<std::vector<std::int32_t>> components;
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    std::int32_t& component = number[sets.of(v)];
    if (component == no_index) component = static_cast<std::int32_t>(std::ssize(components)), components.emplace_back();
    components[component].push_back(v);
  }
  std::ranges::stable_sort(components, {}, [](const auto& component) { return component.size(); });
  return components;
}

}  // namespace hexpipe::graph
