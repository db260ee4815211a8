#include "tools/certify/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/mwis/ground/solution_state.hpp"
#include "common/mwis/ground/target_weight.hpp"

namespace hexpipe::certify {
namespace {

// Passes of the dual; a third of them where a proof follows, whose bound is better.
constexpr std::int64_t usual_passes = mwis::bounds::CliqueDualOptions{}.passes, passes_before_proof = 100;

// Cliques at tets are fewer than those of a cover, and a pass over them takes less time accordingly.
std::int64_t passes_for(const CertifyOptions& options, const KnownCliques& known) {
  if (options.passes) return *options.passes;
  const std::int64_t passes = options.exact ? passes_before_proof : usual_passes;
  return known.of_tets && !known.cover ? 2 * passes : passes;
}

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

// The dual takes all the time that it gets. Before a proof, that is a fifth.
Deadline share_for_dual(const Deadline& deadline) {
  return std::isfinite(deadline.remaining()) ? Deadline(0.2 * deadline.remaining()) : Deadline();
}

graph::CliqueCover cliques_to_price(const graph::ConflictGraph& graph, KnownCliques known) {
  if (known.cover) return std::move(*known.cover);
  return known.of_tets ? graph::maximal_cliques(graph, *known.of_tets) : graph::greedy_edge_clique_cover(graph);
}

// Looks for a better solution until none is possible.
void prove(const graph::ConflictGraph& graph, mwis::ExactAlgorithm algorithm, const Deadline& deadline,
           CertifyResult& result) {
  mwis::exact::ExactResult exact = mwis::solve_exactly(graph, result.weight, algorithm, deadline);
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
  if (options.exact) mwis::expect_room_for(*options.exact, graph);
  CertifyResult result;
  const mwis::bounds::CliqueDualOptions dual{.passes = passes_for(options, known),
                                             .target = total_weight(solution, graph)};
  result.solution = solution;
  result.weight = dual.target;
  result.maximal = is_maximal(graph, solution);
  result.cover = cliques_to_price(graph, std::move(known));
  const Deadline dual_deadline = options.exact ? share_for_dual(deadline) : deadline;
  result.dual = mwis::bounds::solve_clique_dual(graph, result.cover, dual, dual_deadline, report);
  result.bound = result.dual.bound;
  if (options.exact && result.bound > result.weight) prove(graph, *options.exact, deadline, result);
  result.complete = result.bound == result.weight;
  result.gap = mwis::ground::gap_to(result.bound, result.weight);
  count_fixed(graph, result);
  return result;
}

nlohmann::ordered_json to_json(const CertifyResult& result) {
  return {{"weight", result.weight},          {"bound", result.bound},     {"gap", result.gap},
          {"complete", result.complete},      {"maximal", result.maximal}, {"cliques", result.cover.size()},
          {"iterations", result.dual.passes}, {"nodes", result.nodes},     {"fixed_out", result.fixed_out},
          {"fixed_in", result.fixed_in}};
}

std::string summary(const CertifyResult& result) {
  return fmt::format("weight {}, at most {} is possible: gap {:.4f} %{}{}", result.weight, result.bound,
                     100 * result.gap, result.complete ? ", optimal" : "", result.maximal ? "" : ", not maximal");
}

void write_certificate(const graph::CliqueCover& cover, const mwis::bounds::CliqueDual& dual, formats::Output& output) {
  output.print("bound {}\n", dual.bound);
  for (std::int64_t c = 0; c < cover.size(); ++c) {
    if (dual.prices[c] == 0) continue;
    output.print("{}", dual.prices[c]);
    for (const std::int32_t v : cover.clique(c)) output.print(" {}", v + 1);
    output.print("\n");
  }
}

}  // namespace hexpipe::certify
