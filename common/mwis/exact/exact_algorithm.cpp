#include "common/mwis/exact/exact_algorithm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <functional>
#include <limits>
#include <numeric>
#include <type_traits>

#include "common/graph/clique_cover.hpp"
#include "common/mwis/bounds/clique_dual.hpp"
#include "common/mwis/exact/branch_and_bound.hpp"
#include "common/mwis/exact/branch_and_reduce.hpp"
#include "common/mwis/exact/complete_search.hpp"
#include "common/mwis/exact/partition_search.hpp"
#include "common/mwis/exact/subgradient_search.hpp"
#include "common/run/error.hpp"
#ifdef HEXPIPE_WITH_CLP
#include "common/mwis/exact/cutting_planes.hpp"
#endif

namespace hexpipe::mwis::exact {
namespace {

// A search on bits takes a matrix and a row of bits a depth, and SubgradientSearch its prices a depth: some hundred MiB
// at this size. None ends in a lifetime on much less.
constexpr std::int32_t most_on_bits = 4096;
constexpr std::int64_t heaviest_for_subgradient = std::int64_t{1} << 58;

// The order in which the dissertation's algorithms take vertices.
std::vector<std::int32_t> heaviest_first(const graph::ConflictGraph& graph) {
  std::vector<std::int32_t> order(graph.weights.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::int32_t v) { return graph.weights[v]; });
  return order;
}

// Those with little weight around them first, so that weighted covers leave those in the middle of many conflicts for
// branching (exact_solver.cpp): a fiftieth of the nodes on random graphs of 130 vertices, where a partition takes sixty
// times as many.
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

// A node of SubgradientSearch takes up to a tenth of a second, one of the others some microseconds.
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
  result.bound = result.complete ? std::max<std::int64_t>(search.best_weight(), 0)
                                 : std::reduce(graph.weights.begin(), graph.weights.end(), std::int64_t{0});
  return result;
}

bool is_on_bits(ExactAlgorithm algorithm) {
  return algorithm != ExactAlgorithm::branch_and_reduce && algorithm != ExactAlgorithm::branch_and_cut;
}

ExactResult search_by_reductions(const graph::ConflictGraph& graph, std::int64_t weight, ExactAlgorithm algorithm,
                                 const Deadline& deadline) {
  BranchAndReduce search(relaxation_of(algorithm), deadline);
  ExactResult result;
  result.better = search.solve(graph, weight);
  result.complete = search.complete();
  result.bound = search.bound();
  result.nodes = search.nodes();
  return result;
}

}  // namespace

const std::map<std::string, ExactAlgorithm>& exact_algorithms() {
  static const std::map<std::string, ExactAlgorithm> algorithms{
      {"complete-search", ExactAlgorithm::complete_search},     {"clique-partition", ExactAlgorithm::clique_partition},
      {"clique-cover", ExactAlgorithm::clique_cover},           {"clique-lp", ExactAlgorithm::clique_lp},
      {"branch-and-reduce", ExactAlgorithm::branch_and_reduce},
#ifdef HEXPIPE_WITH_CLP
      {"branch-and-cut", ExactAlgorithm::branch_and_cut},
#endif
  };
  return algorithms;
}

std::string default_exact_algorithm() {
  return exact_algorithms().contains("branch-and-cut") ? "branch-and-cut" : "branch-and-reduce";
}

bounds::Relax relaxation_of([[maybe_unused]] ExactAlgorithm algorithm) {
#ifdef HEXPIPE_WITH_CLP
  if (algorithm == ExactAlgorithm::branch_and_cut) return relax_by_cutting_planes;
#endif
  assert(algorithm == ExactAlgorithm::branch_and_reduce);
  return bounds::relax_by_clique_dual;
}

void expect_room_for(ExactAlgorithm algorithm, const graph::ConflictGraph& graph) {
  if (is_on_bits(algorithm) && graph.vertex_count() > most_on_bits)
    throw DataError(fmt::format("expected a graph of at most {} vertices for an algorithm without reductions, found {}",
                                most_on_bits, graph.vertex_count()));
  if (algorithm == ExactAlgorithm::clique_lp &&
      std::reduce(graph.weights.begin(), graph.weights.end(), std::int64_t{0}) >= heaviest_for_subgradient)
    throw DataError("expected weights of a sum below 2^58 for clique-lp, found more");
}

ExactResult solve_exactly(const graph::ConflictGraph& graph, std::int64_t weight, ExactAlgorithm algorithm,
                          const Deadline& deadline) {
  expect_room_for(algorithm, graph);
  switch (algorithm) {
    case ExactAlgorithm::complete_search:
      return search_on_bits<CompleteSearch>(graph, heaviest_first(graph), weight, deadline);
    case ExactAlgorithm::clique_partition:
      return search_on_bits<PartitionSearch>(graph, heaviest_first(graph), weight, deadline);
    case ExactAlgorithm::clique_cover:
      return search_on_bits<BranchAndBound>(graph, least_crowded_first(graph), weight, deadline);
    case ExactAlgorithm::clique_lp:
      return search_on_bits<SubgradientSearch>(graph, heaviest_first(graph), weight, deadline);
    case ExactAlgorithm::branch_and_reduce:
    case ExactAlgorithm::branch_and_cut:
      break;
  }
  return search_by_reductions(graph, weight, algorithm, deadline);
}

}  // namespace hexpipe::mwis::exact
