#include "common/graph/conflict_graph.hpp"

#include <algorithm>
#include <numeric>
#include <ranges>

namespace hexpipe::graph {
namespace {

// Vertices that are known to be connected. A few neighbours of each vertex join nearly all of a component, so most
// edges of the largest one are never looked at (Sutton, Ben-Nun, Barak 2018).
class Trees {
 public:
  explicit Trees(std::size_t vertices) : parents_(vertices) { std::iota(parents_.begin(), parents_.end(), 0); }

  // The least vertex of the tree.
  std::int32_t root(std::int32_t v) {
    while (parents_[v] != v) v = parents_[v] = parents_[parents_[v]];
    return v;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = root(a), b = root(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }
  // no_index if there are no vertices.
  std::int32_t root_of_most() {
    std::vector<std::int32_t> counts(parents_.size(), 0);
    for (std::size_t v = 0; v < parents_.size(); ++v) ++counts[root(static_cast<std::int32_t>(v))];
    const auto most = std::ranges::max_element(counts);
    return most == counts.end() ? no_index : static_cast<std::int32_t>(most - counts.begin());
  }

 private:
  std::vector<std::int32_t> parents_;
};

}  // namespace

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

std::vector<std::vector<std::int32_t>> connected_components(const ConflictGraph& graph) {
  constexpr std::size_t looked_at_first = 2;
  Trees trees(graph.weights.size());
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    for (const std::int32_t u : graph.neighbours_of(v) | std::views::take(looked_at_first)) trees.join(v, u);
  const std::int32_t largest = trees.root_of_most();
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    if (trees.root(v) == largest) continue;
    for (const std::int32_t u : graph.neighbours_of(v)) trees.join(v, u);
  }
  std::vector<std::int32_t> number(graph.weights.size(), no_index);
  std::vector<std::vector<std::int32_t>> components;
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    std::int32_t& component = number[trees.root(v)];
    if (component == no_index) component = static_cast<std::int32_t>(std::ssize(components)), components.emplace_back();
    components[component].push_back(v);
  }
  std::ranges::stable_sort(components, {}, [](const auto& component) { return component.size(); });
  return components;
}

}  // namespace hexpipe::graph
