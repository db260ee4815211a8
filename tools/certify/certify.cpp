#include "tools/certify/certify.hpp"

#include <algorithm>

#include "common/mwis/solution_state.hpp"

namespace hexpipe {
namespace {

bool is_maximal(const ConflictGraph& graph, const IndependentSet& solution) {
  const SolutionState state(graph, solution);
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    if (!state.contains(v) && state.tightness(v) == 0) return false;
  return true;
}

void count_fixed(const ConflictGraph& graph, CertifyResult& result) {
  const std::int64_t slack = result.dual.bound - result.weight;
  for (const std::int64_t cost : reduced_costs(graph, result.cover, result.dual.prices)) {
    if (-cost > slack) ++result.fixed_out;
    if (cost > slack) ++result.fixed_in;
  }
}

}  // namespace

CertifyResult certify(const ConflictGraph& graph, const IndependentSet& solution, const CertifyOptions& options,
                      const Deadline& deadline, const std::function<void(const CliqueDual&)>& report) {
  CertifyResult result;
  result.weight = total_weight(solution, graph);
  result.maximal = is_maximal(graph, solution);
  result.cover = greedy_edge_clique_cover(graph);
  CliqueDualOptions dual = options.dual;
  dual.target = result.weight;
  result.dual = solve_clique_dual(graph, result.cover, dual, deadline, report);
  result.complete = result.dual.bound == result.weight;
  if (result.dual.bound > 0)
    result.gap = static_cast<double>(result.dual.bound - result.weight) / static_cast<double>(result.dual.bound);
  count_fixed(graph, result);
  return result;
}

}  // namespace hexpipe
