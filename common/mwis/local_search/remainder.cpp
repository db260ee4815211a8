#include "common/mwis/local_search/remainder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/exact/exact_solver.hpp"

namespace hexpipe::mwis::local_search {
namespace {

// Reductions of sparse graphs bring more than any search of the same time; on other graphs they decide little.
constexpr double sparse_degree = 16, share_in_sparse = 0.6, share_in_dense = 0.1;
// Larger components are left to the search, and so are those that take more nodes, which is tenths of a second.
constexpr std::size_t most_solved = 512;
constexpr std::int64_t most_nodes = 5000;
// When this many components of similar size took too long, the larger ones would, too.
constexpr int most_failures = 3;

Deadline share_of(const Deadline& deadline, const graph::ConflictGraph& graph) {
  if (!std::isfinite(deadline.remaining())) return Deadline();
  const auto vertices = static_cast<double>(std::max(1, graph.vertex_count()));
  const bool sparse = static_cast<double>(graph.neighbours.size()) / vertices <= sparse_degree;
  return Deadline((sparse ? share_in_sparse : share_in_dense) * deadline.remaining());
}

}  // namespace

Remainder::Remainder(const graph::ConflictGraph& graph, const Deadline& deadline)
    : kernel_(graph, share_of(deadline, graph), reduce::ReductionEffort::worth) {
  solve_components(share_of(deadline, graph));
}

void Remainder::solve_components(const Deadline& deadline) {
  const graph::ConflictGraph& kernel = kernel_.graph();
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
  std::ranges::sort(vertices_);
  graph_ = graph::induced_subgraph(kernel, vertices_);
}

std::vector<std::int32_t> Remainder::in_kernel(std::span<const std::int32_t> of_remainder) const {
  std::vector<std::int32_t> result;
  result.reserve(of_remainder.size());
  for (const std::int32_t v : of_remainder) result.push_back(vertices_[v]);
  return result;
}

graph::IndependentSet Remainder::lift(const graph::IndependentSet& of_remainder) const {
  graph::IndependentSet of_kernel = in_kernel(of_remainder);
  of_kernel.insert(of_kernel.end(), solved_.begin(), solved_.end());
  std::ranges::sort(of_kernel);
  return kernel_.lift(of_kernel);
}

std::vector<std::int32_t> Remainder::originals(std::span<const std::int32_t> of_remainder) const {
  return kernel_.originals(in_kernel(of_remainder));
}

graph::IndependentSet Remainder::project(const graph::IndependentSet& of_whole) const {
  const graph::IndependentSet of_kernel = kernel_.project(of_whole);
  graph::IndependentSet result;
  auto at = vertices_.begin();
  for (const std::int32_t v : of_kernel) {
    at = std::lower_bound(at, vertices_.end(), v);
    if (at != vertices_.end() && *at == v) result.push_back(static_cast<std::int32_t>(at - vertices_.begin()));
  }
  return result;
}

}  // namespace hexpipe::mwis::local_search
