#include "common/mwis/exact/search_on_bits.hpp"

#include <algorithm>
#include <numeric>

#include "common/mwis/exact/branch_and_bound.hpp"
#include "common/mwis/ground/dense_graph.hpp"

namespace hexpipe::mwis::exact {
namespace {

// Shares of all pairs of vertices that are in conflict.
constexpr double dense = 0.03, very_dense = 0.15;

bool has_share_in_conflict(const graph::ConflictGraph& graph, double share) {
  const auto count = static_cast<double>(graph.vertex_count());
  return graph.vertex_count() <= most_on_bits &&
         2 * static_cast<double>(graph.edge_count()) >= share * count * (count - 1);
}

// Vertices with little weight around them come first, so that weighted covers leave those in the middle of many
// conflicts for branching (exact_solver.cpp). On random graphs of 130 vertices this takes a fiftieth of the nodes; for
// a partition, it takes sixty times as many.
std::vector<std::int32_t> least_crowded_first(const graph::ConflictGraph& graph) {
  std::vector<double> crowding(graph.weights.size());
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    for (const std::int32_t u : graph.neighbours_of(v)) crowding[v] += static_cast<double>(graph.weights[u]);
  std::vector<std::int32_t> order(graph.weights.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::int32_t v) { return crowding[v]; });
  return order;
}

}  // namespace

bool is_dense(const graph::ConflictGraph& graph) {
  return has_share_in_conflict(graph, dense);
}

bool is_very_dense(const graph::ConflictGraph& graph) {
  return has_share_in_conflict(graph, very_dense);
}

graph::ConflictGraph renumbered(const graph::ConflictGraph& graph, const std::vector<std::int32_t>& order) {
  std::vector<std::int32_t> numbers(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) numbers[order[i]] = static_cast<std::int32_t>(i);
  graph::ConflictGraph result;
  for (const std::int32_t v : order) {
    result.weights.push_back(graph.weights[v]);
    for (const std::int32_t u : graph.neighbours_of(v)) result.neighbours.push_back(numbers[u]);
    std::sort(result.neighbours.begin() + result.offsets.back(), result.neighbours.end());
    result.offsets.push_back(static_cast<std::int64_t>(result.neighbours.size()));
  }
  return result;
}

graph::IndependentSet numbered_back(std::span<const std::uint32_t> set, const std::vector<std::int32_t>& order) {
  graph::IndependentSet result;
  for (const std::uint32_t v : set) result.push_back(order[v]);
  std::ranges::sort(result);
  return result;
}

std::optional<graph::IndependentSet> search_on_bits(const graph::ConflictGraph& graph, std::int64_t needed,
                                                    ground::SearchBudget& budget) {
  const std::vector<std::int32_t> order = least_crowded_first(graph);
  BranchAndBound search;
  if (!search.solve(ground::dense_graph_of(renumbered(graph, order)), needed, budget)) return std::nullopt;
  return numbered_back(search.best(), order);
}

}  // namespace hexpipe::mwis::exact
