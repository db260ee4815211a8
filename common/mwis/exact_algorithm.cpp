#include "common/mwis/exact_algorithm.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/mwis/bounds/clique_dual.hpp"
#include "common/mwis/exact/historical/searches_on_bits.hpp"
#include "common/mwis/exact/search_on_bits.hpp"
#include "common/mwis/ground/search_budget.hpp"
#ifdef HEXPIPE_WITH_CLP
#include "common/mwis/exact/packing_program.hpp"
#endif

namespace hexpipe::mwis {
namespace {

bool is_on_bits(ExactAlgorithm algorithm) {
  return algorithm != ExactAlgorithm::branch_and_reduce && algorithm != ExactAlgorithm::branch_and_cut;
}

// The shares of the time left that the first of both takes: of that on bits, and of that by reductions, which gets as
// many seconds at least. Where the relaxation is tight it needs no more: of the graphs that were tried
// (docs/log/mwis.md) the slowest one took 5 s.
constexpr double share_on_bits = 0.7, share_by_reductions = 0.25, least_by_reductions = 2;

Deadline share_of(double share, double least, const Deadline& deadline) {
  const double left = deadline.remaining();
  return std::isfinite(left) ? Deadline(std::min(left, std::max(share * left, least))) : Deadline();
}

exact::ExactResult search_by_reductions(const graph::ConflictGraph& graph, std::int64_t weight,
                                        ExactAlgorithm algorithm, const Deadline& deadline) {
  exact::BranchAndReduce search(relaxation_of(algorithm), deadline);
  exact::ExactResult result;
  result.better = search.solve(graph, weight);
  result.complete = search.complete();
  result.bound = search.bound();
  result.nodes = search.nodes();
  return result;
}

// Adds what a search on bits finds and proves.
void search_on_bits(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline,
                    exact::ExactResult& result) {
  if (result.better) weight = graph::total_weight(*result.better, graph);
  ground::SearchBudget budget(std::numeric_limits<std::int64_t>::max(), &deadline);
  if (auto better = exact::search_on_bits(graph, weight, budget)) {
    weight = graph::total_weight(*better, graph);
    result.better = std::move(better);
  }
  result.nodes += budget.spent();
  result.complete = !budget.exhausted();
  if (result.complete) result.bound = weight;
}

// In turns: what is less likely to prove a graph takes the rest of the time.
exact::ExactResult search_dense(const graph::ConflictGraph& graph, std::int64_t weight, ExactAlgorithm algorithm,
                                const Deadline& deadline) {
  exact::ExactResult result;
  const bool bits_first = exact::is_very_dense(graph);
  if (bits_first) {
    search_on_bits(graph, weight, share_of(share_on_bits, 0, deadline), result);
    if (result.complete) return result;
    if (result.better) weight = graph::total_weight(*result.better, graph);
  }
  exact::ExactResult reduced = search_by_reductions(
      graph, weight, algorithm, bits_first ? deadline : share_of(share_by_reductions, least_by_reductions, deadline));
  if (!reduced.better) reduced.better = std::move(result.better);
  reduced.nodes += result.nodes;
  if (!bits_first && !reduced.complete) search_on_bits(graph, weight, deadline, reduced);
  return reduced;
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
  if (algorithm == ExactAlgorithm::branch_and_cut) return exact::relax_by_cutting_planes;
#endif
  assert(algorithm == ExactAlgorithm::branch_and_reduce);
  return bounds::relax_by_clique_dual;
}

void expect_room_for(ExactAlgorithm algorithm, const graph::ConflictGraph& graph) {
  if (is_on_bits(algorithm)) exact::historical::expect_room_on_bits(graph);
  if (algorithm == ExactAlgorithm::clique_lp) exact::historical::expect_room_for_clique_lp(graph);
}

exact::ExactResult solve_exactly(const graph::ConflictGraph& graph, std::int64_t weight, ExactAlgorithm algorithm,
                                 const Deadline& deadline) {
  expect_room_for(algorithm, graph);
  switch (algorithm) {
    case ExactAlgorithm::complete_search:
      return exact::historical::search_completely(graph, weight, deadline);
    case ExactAlgorithm::clique_partition:
      return exact::historical::search_by_clique_partition(graph, weight, deadline);
    case ExactAlgorithm::clique_cover:
      return exact::historical::search_by_clique_cover(graph, weight, deadline);
    case ExactAlgorithm::clique_lp:
      return exact::historical::search_by_clique_lp(graph, weight, deadline);
    case ExactAlgorithm::branch_and_reduce:
    case ExactAlgorithm::branch_and_cut:
      break;
  }
  return exact::is_dense(graph) ? search_dense(graph, weight, algorithm, deadline)
                                : search_by_reductions(graph, weight, algorithm, deadline);
}

}  // namespace hexpipe::mwis
