#include "common/mwis/exact/historical/searches_on_bits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <type_traits>
#include <vector>

#include "common/graph/clique_cover.hpp"
#include "common/mwis/exact/branch_and_bound.hpp"
#include "common/mwis/exact/historical/complete_search.hpp"
#include "common/mwis/exact/historical/subgradient_search.hpp"
#include "common/run/error.hpp"

namespace hexpipe::mwis::exact::historical {
namespace {

// A search on bits takes a matrix and a row of bits for each depth, and SubgradientSearch takes its prices for each
// depth. That is some hundred MiB at this size. No search ends in a lifetime on much smaller graphs.
constexpr std::int32_t most_on_bits = 4096;
constexpr std::int64_t heaviest_for_subgradient = std::int64_t{1} << 58;

std::int64_t sum_of_weights(const graph::ConflictGraph& graph) {
  return std::reduce(graph.weights.begin(), graph.weights.end(), std::int64_t{0});
}

// The order in which the dissertation's algorithms take vertices.
std::vector<std::int32_t> heaviest_first(const graph::ConflictGraph& graph) {
  std::vector<std::int32_t> order(graph.weights.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::int32_t v) { return graph.weights[v]; });
  return order;
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

// A node of SubgradientSearch takes up to a tenth of a second; a node of the others takes some microseconds.
template <class Search>
constexpr std::int64_t nodes_a_look =
    std::is_same_v<Search, SubgradientSearch> ? 1 : ground::SearchBudget::usual_nodes_a_look;

template <class Search>
bool run(Search& search, const graph::ConflictGraph& graph, std::int64_t weight, ground::SearchBudget& budget) {
  return search.solve(ground::dense_graph_of(graph), weight, budget);
}

bool run(SubgradientSearch& search, const graph::ConflictGraph& graph, std::int64_t weight,
         ground::SearchBudget& budget) {
  return search.solve(ground::dense_graph_of(graph), graph::greedy_edge_clique_cover(graph), weight, budget);
}

template <class Search>
ExactResult search_on_bits(const graph::ConflictGraph& graph, const std::vector<std::int32_t>& order,
                           std::int64_t weight, const Deadline& deadline) {
  Search search;
  ground::SearchBudget budget(std::numeric_limits<std::int64_t>::max(), &deadline, nodes_a_look<Search>);
  const bool found = run(search, renumbered(graph, order), weight, budget);
  ExactResult result;
  result.complete = !budget.exhausted();
  result.nodes = budget.spent();
  if (found) {
    graph::IndependentSet& better = result.better.emplace();
    for (const std::uint32_t v : search.best()) better.push_back(order[v]);
    std::ranges::sort(better);
  }
  result.bound = result.complete ? std::max<std::int64_t>(search.best_weight(), 0) : sum_of_weights(graph);
  return result;
}

}  // namespace

ExactResult search_completely(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline) {
  return search_on_bits<CompleteSearch>(graph, heaviest_first(graph), weight, deadline);
}

ExactResult search_by_clique_partition(const graph::ConflictGraph& graph, std::int64_t weight,
                                       const Deadline& deadline) {
  return search_on_bits<PartitionSearch>(graph, heaviest_first(graph), weight, deadline);
}

ExactResult search_by_clique_cover(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline) {
  return search_on_bits<BranchAndBound>(graph, least_crowded_first(graph), weight, deadline);
}

ExactResult search_by_clique_lp(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline) {
  return search_on_bits<SubgradientSearch>(graph, heaviest_first(graph), weight, deadline);
}

void expect_room_on_bits(const graph::ConflictGraph& graph) {
  if (graph.vertex_count() > most_on_bits)
    throw DataError(fmt::format("expected a graph of at most {} vertices for an algorithm without reductions, found {}",
                                most_on_bits, graph.vertex_count()));
}

void expect_room_for_clique_lp(const graph::ConflictGraph& graph) {
  if (sum_of_weights(graph) >= heaviest_for_subgradient)
    throw DataError("expected weights of a sum below 2^58 for clique-lp, found more");
}

}  // namespace hexpipe::mwis::exact::historical
