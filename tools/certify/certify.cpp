#include "tools/certify/certify.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/mwis/ground/solution_state.hpp"
#include "common/mwis/ground/target_weight.hpp"

namespace hexpipe::certify {
namespace {

bool is_maximal(const graph::ConflictGraph& graph, const graph::IndependentSet& solution) {
  const mwis::ground::SolutionState state(graph, solution);
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    if (!state.contains(v) && state.tightness(v) == 0) return false;
  return true;
}

void count_fixed(const graph::ConflictGraph& graph, CertifyResult& result) {
  const std::int64_t slack = result.dual.bound - result.weight;
  for (const std::int64_t cost : mwis::bounds::reduced_costs(graph, result.cover, result.dual.prices)) {
    if (-cost > slack) ++result.fixed_out;
    if (cost > slack) ++result.fixed_in;
  }
}

// The dual takes all the time there is, so of what a proof has it gets a fifth.
Deadline share_for_dual(const Deadline& deadline) {
  return std::isfinite(deadline.remaining()) ? Deadline(0.2 * deadline.remaining()) : Deadline();
}

graph::CliqueCover cliques_to_price(const graph::ConflictGraph& graph, KnownCliques known) {
  if (known.cover) return std::move(*known.cover);
  return known.of_tets ? graph::maximal_cliques(graph, *known.of_tets) : graph::greedy_edge_clique_cover(graph);
}

// Looks for something better until nothing can be.
void prove(const graph::ConflictGraph& graph, mwis::exact::ExactAlgorithm algorithm, const Deadline& deadline,
           CertifyResult& result) {
  mwis::exact::ExactResult exact = mwis::exact::solve_exactly(graph, result.weight, algorithm, deadline);
  result.nodes = exact.nodes;
  if (exact.better) {
    result.solution = std::move(*exact.better);
    result.weight = graph::total_weight(result.solution, graph);
    result.maximal = is_maximal(graph, result.solution);
  }
  result.bound = exact.complete ? result.weight : std::min(result.bound, std::max(exact.bound, result.weight));
}

}  // namespace

CertifyResult certify(const graph::ConflictGraph& graph, const graph::IndependentSet& solution, KnownCliques known,
                      const CertifyOptions& options, const Deadline& deadline,
                      const std::function<void(const mwis::bounds::CliqueDual&)>& report) {
  if (options.exact) mwis::exact::expect_room_for(*options.exact, graph);
  CertifyResult result;
  result.solution = solution;
  result.weight = graph::total_weight(solution, graph);
  result.maximal = is_maximal(graph, solution);
  result.cover = cliques_to_price(graph, std::move(known));
  mwis::bounds::CliqueDualOptions dual = options.dual;
  dual.target = result.weight;
  const Deadline dual_deadline = options.exact ? share_for_dual(deadline) : deadline;
  result.dual = mwis::bounds::solve_clique_dual(graph, result.cover, dual, dual_deadline, report);
  result.bound = result.dual.bound;
  if (options.exact && result.bound > result.weight) prove(graph, *options.exact, deadline, result);
  result.complete = result.bound == result.weight;
  result.gap = mwis::ground::gap_to(result.bound, result.weight);
  count_fixed(graph, result);
  return result;
}

}  // namespace hexpipe::certify
