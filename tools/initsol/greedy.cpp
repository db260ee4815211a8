#include "tools/initsol/greedy.hpp"

#include <algorithm>
#include <numeric>

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
