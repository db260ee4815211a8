#include "common/mwis/local_search/remainder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/exact/exact_solver.hpp"
#include "common/mwis/ground/solution_state.hpp"
#include "common/mwis/reduce/sample.hpp"

namespace hexpipe::mwis::local_search {
namespace {

// Reductions of sparse graphs bring more than any search of the same time; on other graphs they decide little.
constexpr double share_in_sparse = 0.6, share_in_dense = 0.1;
// Larger components are left to the search, and so are those that take more nodes, which is tenths of a second.
constexpr std::size_t most_solved = 512;
constexpr std::int64_t most_nodes = 5000;
// When this many components of similar size took too long, the larger ones would, too.
constexpr int most_failures = 3;

Deadline share_of(const Deadline& deadline, const graph::ConflictGraph& graph) {
  if (!std::isfinite(deadline.remaining())) return Deadline();
  return Deadline(
      (reduce::is_sparse(graph.vertex_count(), std::ssize(graph.neighbours)) ? share_in_sparse : share_in_dense) *
      deadline.remaining());
}

bool is_worth_reducing(const graph::ConflictGraph& graph, const Deadline& deadline) {
  return !reduce::needs_sample(graph.vertex_count(), std::ssize(graph.neighbours)) ||
         reduce::reduce_sample(graph, reduce::places_of_sample, {}, deadline).decides_enough();
}

}  // namespace

Remainder::Remainder(const graph::ConflictGraph& graph, const Deadline& deadline) : whole_(graph) {
  if (is_worth_reducing(graph, share_of(deadline, graph)))
    kernel_.emplace(graph, share_of(deadline, graph), reduce::ReductionEffort::worth);
  solve_components(share_of(deadline, graph));
}

void Remainder::solve_components(const Deadline& deadline) {
  const graph::ConflictGraph& kernel = this->kernel();
  exact::ExactSolver solver;
  std::vector<bits::Word> chosen;
  int failures = 0;
  for (const auto& component : graph::connected_components(kernel)) {
    bool solved = false;
    if (component.size() <= most_solved && failures < most_failures && !deadline.passed()) {
      ground::DenseGraph dense = ground::dense_graph_of(graph::induced_subgraph(kernel, component));
      chosen.assign(dense.words(), 0);
      ground::SearchBudget budget(most_nodes, &deadline);
      solved = solver.solve(dense, chosen, budget);
      failures += solved ? 0 : 1;
    }
    if (!solved) {
      vertices_.insert(vertices_.end(), component.begin(), component.end());
      continue;
    }
    bits::for_each(chosen.data(), chosen.size(), [&](std::size_t i) {
      solved_.push_back(component[i]);
      solved_weight_ += kernel.weights[component[i]];
    });
  }
  is_whole_ = vertices_.size() == kernel.weights.size();
  if (is_whole_) return;
  std::ranges::sort(vertices_);
  graph_ = graph::induced_subgraph(kernel, vertices_);
}

std::vector<std::int32_t> Remainder::in_kernel(std::span<const std::int32_t> of_remainder) const {
  std::vector<std::int32_t> result(of_remainder.begin(), of_remainder.end());
  if (!is_whole_)
    for (std::int32_t& v : result) v = vertices_[v];
  return result;
}

graph::IndependentSet Remainder::lift(const graph::IndependentSet& of_remainder) const {
  graph::IndependentSet of_kernel = in_kernel(of_remainder);
  of_kernel.insert(of_kernel.end(), solved_.begin(), solved_.end());
  std::ranges::sort(of_kernel);
  if (kernel_) return kernel_->lift(of_kernel);
  ground::SolutionState state(whole_, of_kernel);
  state.make_maximal();
  return state.to_set();
}

std::vector<std::int32_t> Remainder::originals(std::span<const std::int32_t> of_remainder) const {
  std::vector<std::int32_t> of_kernel = in_kernel(of_remainder);
  return kernel_ ? kernel_->originals(of_kernel) : of_kernel;
}

graph::IndependentSet Remainder::project(const graph::IndependentSet& of_whole) const {
  graph::IndependentSet of_kernel = kernel_ ? kernel_->project(of_whole) : of_whole;
  if (is_whole_) return of_kernel;
  graph::IndependentSet result;
  auto at = vertices_.begin();
  for (const std::int32_t v : of_kernel) {
    at = std::lower_bound(at, vertices_.end(), v);
    if (at != vertices_.end() && *at == v) result.push_back(static_cast<std::int32_t>(at - vertices_.begin()));
  }
  return result;
}

}  // namespace hexpipe::mwis::local_search
