#include "tools/initsol/greedy.hpp"

#include <algorithm>
#include <numeric>

namespace hexpipe::initsol {

std::vector<double> merits(const graph::ConflictGraph& graph, GreedyOrder order, std::span<const double> quality) {
  if (order == GreedyOrder::quality) return {quality.begin(), quality.end()};
  std::vector<double> merits(graph.weights.begin(), graph.weights.end());
  if (order == GreedyOrder::weight_degree)
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v) merits[v] /= static_cast<double>(graph.degree(v) + 1);
  return merits;
}

graph::IndependentSet greedy(const graph::ConflictGraph& graph, std::span<const double> merits) {
  std::vector<std::int32_t> order(graph.weights.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](std::int32_t a, std::int32_t b) { return merits[a] > merits[b]; });

  std::vector<char> excluded(graph.weights.size(), 0);
  graph::IndependentSet solution;
  for (const std::int32_t v : order) {
    if (excluded[v]) continue;
    solution.push_back(v);
    for (const std::int32_t u : graph.neighbours_of(v)) excluded[u] = 1;
  }
  std::ranges::sort(solution);
  return solution;
}

}  // namespace hexpipe::initsol
