#include "tools/initsol/greedy.hpp"

#include <algorithm>
#include <vector>

namespace hexpipe::initsol {

std::vector<double> merits(const graph::ConflictGraph& graph, GreedyOrder order, std::span<const double> quality,
                           std::int32_t quads) {
  const std::int32_t others = graph.vertex_count() - quads;
  std::vector<double> merits(graph.weights.begin(), graph.weights.end());
  if (order == GreedyOrder::quality) std::ranges::copy(quality.first(static_cast<std::size_t>(others)), merits.begin());
  if (order == GreedyOrder::weight_degree)
    for (std::int32_t v = 0; v < others; ++v) merits[v] /= static_cast<double>(graph.degree(v) + 1);
  std::fill(merits.begin() + others, merits.end(), -1.0);
  return merits;
}

graph::IndependentSet greedy(const graph::ConflictGraph& graph, std::span<const double> merits) {
  // Merits lie beside their vertices, so that sorting reads no others.
  struct Entry {
    double merit;
    std::int32_t vertex;
  };
  std::vector<Entry> order;
  order.reserve(merits.size());
  for (const double merit : merits) order.push_back({merit, static_cast<std::int32_t>(order.size())});
  std::ranges::sort(order, [](const Entry& a, const Entry& b) {
    return a.merit > b.merit || (a.merit == b.merit && a.vertex < b.vertex);
  });

  std::vector<char> excluded(graph.weights.size(), 0);
  graph::IndependentSet solution;
  for (const auto& [merit, v] : order) {
    if (excluded[v]) continue;
    solution.push_back(v);
    for (const std::int32_t u : graph.neighbours_of(v)) excluded[u] = 1;
  }
  std::ranges::sort(solution);
  return solution;
}

}  // namespace hexpipe::initsol
