#include "formats/choice/edges.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "common/run/memory.hpp"

namespace hexpipe::formats {

graph::ConflictGraph graph_of_edges(std::vector<std::int64_t> weights, const std::vector<std::int32_t>& ends) {
  graph::ConflictGraph graph;
  graph.weights = std::move(weights);
  std::vector<std::int64_t> places(graph.weights.size() + 1, 0);
  for (const std::int32_t v : ends) ++places[v + 1];
  for (std::size_t v = 1; v < places.size(); ++v) places[v] += places[v - 1];
  std::vector<std::int32_t>& lists = graph.neighbours;
  lists.resize(ends.size());
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    lists[places[ends[i]]++] = ends[i + 1];
    lists[places[ends[i + 1]]++] = ends[i];
  }
  // places[v] is now where the list of v ends.
  std::int64_t begin = 0, kept = 0;
  for (std::size_t v = 0; v < graph.weights.size(); ++v) {
    const auto list = std::span(lists).subspan(begin, places[v] - begin);
    begin = places[v];
    std::ranges::sort(list);
    const auto repeated = std::unique(list.begin(), list.end());
    kept = std::copy(list.begin(), repeated, lists.begin() + kept) - lists.begin();
    graph.offsets.push_back(kept);
  }
  lists.resize(kept);
  return graph;
}

graph::ConflictGraph complement_of(const graph::ConflictGraph& graph, const std::string& source) {
  const auto vertices = static_cast<std::uint64_t>(graph.vertex_count());
  const std::uint64_t count = vertices == 0 ? 0 : vertices * (vertices - 1) - graph.neighbours.size();
  expect_memory(count, sizeof(std::int32_t), source);
  graph::ConflictGraph complement;
  complement.weights = graph.weights;
  complement.neighbours.reserve(count);
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    const auto neighbours = graph.neighbours_of(v);
    auto next = neighbours.begin();
    for (std::int32_t u = 0; u < graph.vertex_count(); ++u) {
      if (next != neighbours.end() && *next == u)
        ++next;
      else if (u != v)
        complement.neighbours.push_back(u);
    }
    complement.offsets.push_back(static_cast<std::int64_t>(complement.neighbours.size()));
  }
  return complement;
}

}  // namespace hexpipe::formats
