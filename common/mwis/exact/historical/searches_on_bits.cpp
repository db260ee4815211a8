#include "common/mwis/exact/historical/searches_on_bits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <type_traits>
#include <vector>

#include "common/graph/clique_cover.hpp"
#include "common/mwis/exact/historical/complete_search.hpp"
#include "common/mwis/exact/historical/subgradient_search.hpp"
#include "common/mwis/exact/search_on_bits.hpp"
#include "common/run/error.hpp"

namespace hexpipe::mwis::exact::historical {
namespace {

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

ExactResult result_of(std::optional<graph::IndependentSet> better, std::int64_t weight,
                      const graph::ConflictGraph& graph, const ground::SearchBudget& budget) {
  ExactResult result;
  result.complete = !budget.exhausted();
  result.nodes = budget.spent();
  const std::int64_t best = better ? graph::total_weight(*better, graph) : weight;
  result.better = std::move(better);
  result.bound = result.complete ? std::max<std::int64_t>(best, 0) : sum_of_weights(graph);
  return result;
}

template <class Search>
ExactResult search_heaviest_first(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline) {
  const std::vector<std::int32_t> order = heaviest_first(graph);
  Search search;
  ground::SearchBudget budget(std::numeric_limits<std::int64_t>::max(), &deadline, nodes_a_look<Search>);
  std::optional<graph::IndependentSet> better;
  if (run(search, renumbered(graph, order), weight, budget)) better = numbered_back(search.best(), order);
  return result_of(std::move(better), weight, graph, budget);
}

}  // namespace

ExactResult search_completely(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline) {
  return search_heaviest_first<CompleteSearch>(graph, weight, deadline);
}

ExactResult search_by_clique_partition(const graph::ConflictGraph& graph, std::int64_t weight,
                                       const Deadline& deadline) {
  return search_heaviest_first<PartitionSearch>(graph, weight, deadline);
}

ExactResult search_by_clique_cover(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline) {
  ground::SearchBudget budget(std::numeric_limits<std::int64_t>::max(), &deadline);
  std::optional<graph::IndependentSet> better = search_on_bits(graph, weight, budget);
  return result_of(std::move(better), weight, graph, budget);
}

ExactResult search_by_clique_lp(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline) {
  return search_heaviest_first<SubgradientSearch>(graph, weight, deadline);
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
