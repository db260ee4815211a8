#include "common/mwis/branch_and_reduce.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "common/graph/clique_cover.hpp"
#include "common/graph/subgraph.hpp"
#include "common/mwis/clique_dual.hpp"
#include "common/mwis/kernel.hpp"

namespace hexpipe {
namespace {

// Passes of the dual before the first branch, and in a node.
constexpr std::int64_t root_passes = 900, node_passes = 60;

IndependentSet renumbered(const IndependentSet& set, const std::vector<std::int32_t>& vertices) {
  IndependentSet result;
  for (const std::int32_t v : set) result.push_back(vertices[v]);
  return result;
}

std::vector<std::int32_t> without_neighbourhood(const ConflictGraph& graph, std::int32_t v) {
  std::vector<char> gone(graph.weights.size(), 0);
  gone[v] = 1;
  for (const std::int32_t u : graph.neighbours_of(v)) gone[u] = 1;
  std::vector<std::int32_t> rest;
  for (std::int32_t u = 0; u < graph.vertex_count(); ++u)
    if (gone[u] == 0) rest.push_back(u);
  return rest;
}

}  // namespace

struct BranchAndReduce::Component {
  std::vector<std::int32_t> vertices;  // of the graph that it is a part of
  ConflictGraph graph;
  std::int64_t bound = 0;
  std::vector<std::int64_t> reduced_costs;
};

std::optional<IndependentSet> BranchAndReduce::solve(const ConflictGraph& graph, std::int64_t needed) {
  nodes_ = 0;
  bound_ = 0;
  kernel_size_ = 0;
  stopped_ = false;
  return reduce(graph, needed, 0);
}

bool BranchAndReduce::stop() {
  stopped_ = stopped_ || deadline_.passed();
  return stopped_;
}

std::optional<IndependentSet> BranchAndReduce::reduce(const ConflictGraph& graph, std::int64_t needed, int depth) {
  if (stop()) return std::nullopt;
  ++nodes_;
  const Kernel kernel(graph, deadline_, depth == 0 ? ReductionEffort::thorough : ReductionEffort::full);
  if (depth == 0) {
    kernel_size_ = kernel.graph().vertex_count();
    bound_ = kernel.offset();
  }
  const auto found = solve_components(kernel.graph(), needed - kernel.offset(), depth);
  if (!found) return std::nullopt;
  return kernel.lift(*found);
}

// Each component has to bring what is needed beyond the bounds of the others.
std::optional<IndependentSet> BranchAndReduce::solve_components(const ConflictGraph& graph, std::int64_t needed,
                                                                int depth) {
  std::vector<Component> components;
  std::int64_t bound = 0;
  for (auto& vertices : connected_components(graph)) {
    Component& component = components.emplace_back();
    component.graph = induced_subgraph(graph, vertices);
    component.vertices = std::move(vertices);
    CliqueCover cover = greedy_edge_clique_cover(component.graph);
    const CliqueDual dual =
        solve_clique_dual(component.graph, cover, {.passes = depth == 0 ? root_passes : node_passes}, deadline_);
    component.reduced_costs = reduced_costs(component.graph, cover, dual.prices);
    component.bound = dual.bound;
    bound += dual.bound;
  }
  if (depth == 0) bound_ += bound;
  if (bound <= needed) return std::nullopt;
  IndependentSet whole;
  for (const Component& component : components) {
    const auto found = solve_component(component, needed - (bound - component.bound), depth);
    if (!found) return std::nullopt;
    bound += total_weight(*found, component.graph) - component.bound;
    for (const std::int32_t v : *found) whole.push_back(component.vertices[v]);
    if (bound <= needed) return std::nullopt;
  }
  std::ranges::sort(whole);
  return whole;
}

std::optional<IndependentSet> BranchAndReduce::solve_component(const Component& component, std::int64_t needed,
                                                               int depth) {
  if (component.graph.vertex_count() <= small_) return solve_small(component.graph, needed);
  const std::int64_t slack = component.bound - needed;
  std::vector<std::int32_t> left;
  for (std::int32_t v = 0; v < component.graph.vertex_count(); ++v)
    if (-component.reduced_costs[v] < slack) left.push_back(v);
  if (20 * left.size() > 19 * component.vertices.size()) return branch(component, needed, depth);
  const auto found = reduce(induced_subgraph(component.graph, left), needed, depth + 1);
  if (!found) return std::nullopt;
  return renumbered(*found, left);
}

std::optional<IndependentSet> BranchAndReduce::solve_small(const ConflictGraph& graph, std::int64_t needed) {
  DenseGraph dense(graph.weights.size());
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    dense.set_weight(v, graph.weights[v]);
    for (const std::int32_t u : graph.neighbours_of(v)) bits::insert(dense.row(v), static_cast<std::size_t>(u));
  }
  std::vector<bits::Word> chosen(dense.words(), 0);
  SearchBudget budget(std::numeric_limits<std::int64_t>::max(), &deadline_);
  stopped_ = !small_solver_.solve(dense, chosen, budget) || stopped_;
  IndependentSet set;
  bits::for_each(chosen.data(), chosen.size(), [&](std::size_t v) { set.push_back(static_cast<std::int32_t>(v)); });
  if (total_weight(set, graph) <= needed) return std::nullopt;
  return set;
}

// On the vertex with the most neighbours: with it, then without.
std::optional<IndependentSet> BranchAndReduce::branch(const Component& component, std::int64_t needed, int depth) {
  const ConflictGraph& graph = component.graph;
  std::int32_t v = 0;
  for (std::int32_t u = 1; u < graph.vertex_count(); ++u)
    if (graph.degree(u) > graph.degree(v)) v = u;
  std::optional<IndependentSet> best;
  const std::vector<std::int32_t> beside = without_neighbourhood(graph, v);
  if (const auto found = reduce(induced_subgraph(graph, beside), needed - graph.weights[v], depth + 1)) {
    best = renumbered(*found, beside);
    best->insert(std::ranges::lower_bound(*best, v), v);
    needed = total_weight(*best, graph);
  }
  std::vector<std::int32_t> others(graph.weights.size());
  std::iota(others.begin(), others.end(), 0);
  others.erase(others.begin() + v);
  if (const auto found = reduce(induced_subgraph(graph, others), needed, depth + 1)) best = renumbered(*found, others);
  return best;
}

}  // namespace hexpipe
