#include "common/mwis/exact/branch_and_reduce.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/exact/search_on_bits.hpp"
#include "common/mwis/reduce/kernel.hpp"

namespace hexpipe::mwis::exact {
namespace {

// Very dense components of more vertices are searched on bits before they are relaxed, up to so many nodes: about as
// long as that takes.
constexpr std::int32_t least_on_bits = 100;
constexpr std::int64_t nodes_on_bits = 1 << 14;

graph::IndependentSet renumbered(const graph::IndependentSet& set, const std::vector<std::int32_t>& vertices) {
  graph::IndependentSet result;
  for (const std::int32_t v : set) result.push_back(vertices[v]);
  return result;
}

std::vector<std::int32_t> without_neighbourhood(const graph::ConflictGraph& graph, std::int32_t v) {
  std::vector<char> gone(graph.weights.size(), 0);
  gone[v] = 1;
  for (const std::int32_t u : graph.neighbours_of(v)) gone[u] = 1;
  std::vector<std::int32_t> rest;
  for (std::int32_t u = 0; u < graph.vertex_count(); ++u)
    if (gone[u] == 0) rest.push_back(u);
  return rest;
}

// The vertex, by weight, for which the relaxation is least decided. A vertex with many neighbours decides most of the
// others, which counts when the relaxation decides all.
std::int32_t branching_vertex(const graph::ConflictGraph& graph, const bounds::Relaxation& relaxation) {
  const auto rank = [&](std::int32_t v) {
    const double fraction = relaxation.fractions.empty() ? 0 : relaxation.fractions[v];
    return std::pair(std::min(fraction, 1 - fraction) * static_cast<double>(graph.weights[v]), graph.degree(v));
  };
  std::int32_t best = 0;
  for (std::int32_t v = 1; v < graph.vertex_count(); ++v)
    if (rank(v) > rank(best)) best = v;
  return best;
}

}  // namespace

struct BranchAndReduce::Component {
  std::vector<std::int32_t> vertices;  // in the graph that the component belongs to
  graph::ConflictGraph graph;
  bounds::Relaxation relaxation;
  std::optional<graph::IndependentSet> optimum;  // if it is known
};

std::optional<graph::IndependentSet> BranchAndReduce::solve(const graph::ConflictGraph& graph, std::int64_t needed) {
  nodes_ = 0;
  bound_ = std::reduce(graph.weights.begin(), graph.weights.end(), std::int64_t{0});
  stopped_ = false;
  return reduce(graph, needed, 0);
}

bool BranchAndReduce::stop() {
  stopped_ = stopped_ || deadline_.passed();
  return stopped_;
}

std::optional<graph::IndependentSet> BranchAndReduce::reduce(const graph::ConflictGraph& graph, std::int64_t needed,
                                                             int depth) {
  if (stop()) return std::nullopt;
  ++nodes_;
  const reduce::Kernel kernel(graph, deadline_,
                              depth == 0 ? reduce::ReductionEffort::thorough : reduce::ReductionEffort::full);
  if (depth == 0) offset_ = kernel.offset();
  const auto found = solve_components(kernel.graph(), needed - kernel.offset(), depth);
  if (!found) return std::nullopt;
  return kernel.lift(*found);
}

// The smallest component comes first. The bounds of the others tell how low the bound of the last and largest one has
// to be to end this node.
std::vector<BranchAndReduce::Component> BranchAndReduce::bound_components(const graph::ConflictGraph& graph,
                                                                          std::int64_t needed, int depth) {
  std::vector<Component> components;
  std::int64_t others = 0;
  for (auto& vertices : graph::connected_components(graph)) {
    const bool last = vertices.size() > graph.weights.size() / 2;
    Component& component = components.emplace_back();
    component.graph = graph::induced_subgraph(graph, vertices);
    component.vertices = std::move(vertices);
    const std::int64_t lacking = last ? needed - others : 0;
    if (component.graph.vertex_count() <= small_)
      solve_small(component);
    else if (!solve_dense(component, lacking))
      component.relaxation = relax_(component.graph, lacking, depth, deadline_);
    others += component.relaxation.bound;
  }
  return components;
}

// Each component has to contribute what is needed beyond the bounds of the others.
std::optional<graph::IndependentSet> BranchAndReduce::solve_components(const graph::ConflictGraph& graph,
                                                                       std::int64_t needed, int depth) {
  const std::vector<Component> components = bound_components(graph, needed, depth);
  std::int64_t bound = 0;
  for (const Component& component : components) bound += component.relaxation.bound;
  if (depth == 0) bound_ = std::min(bound_, offset_ + bound);
  if (bound <= needed) return std::nullopt;
  graph::IndependentSet whole;
  for (const Component& component : components) {
    const auto found = solve_component(component, needed - (bound - component.relaxation.bound), depth);
    if (!found) return std::nullopt;
    bound += graph::total_weight(*found, component.graph) - component.relaxation.bound;
    for (const std::int32_t v : *found) whole.push_back(component.vertices[v]);
    if (bound <= needed) return std::nullopt;
  }
  std::ranges::sort(whole);
  return whole;
}

std::optional<graph::IndependentSet> BranchAndReduce::solve_component(const Component& component, std::int64_t needed,
                                                                      int depth) {
  if (component.optimum) return component.optimum;
  const graph::ConflictGraph& graph = component.graph;
  const bounds::Relaxation& relaxation = component.relaxation;
  std::vector<char> out(graph.weights.size(), 0);
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
    if (relaxation.with[v] <= needed) out[v] = 1;
    if (relaxation.without[v] > needed) continue;
    for (const std::int32_t u : graph.neighbours_of(v)) out[u] = 1;
  }
  std::vector<std::int32_t> left;
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    if (out[v] == 0) left.push_back(v);
  if (20 * left.size() > 19 * component.vertices.size()) return branch(component, needed, depth);
  const auto found = reduce(graph::induced_subgraph(graph, left), needed, depth + 1);
  if (!found) return std::nullopt;
  return renumbered(*found, left);
}

void BranchAndReduce::solve_small(Component& component) {
  const graph::ConflictGraph& graph = component.graph;
  ground::DenseGraph dense = ground::dense_graph_of(graph);
  std::vector<bits::Word> chosen(dense.words(), 0);
  ground::SearchBudget budget(std::numeric_limits<std::int64_t>::max(), &deadline_);
  const bool complete = small_solver_.solve(dense, chosen, budget);
  stopped_ = stopped_ || !complete;
  graph::IndependentSet& set = component.optimum.emplace();
  bits::for_each(chosen.data(), chosen.size(), [&](std::size_t v) { set.push_back(static_cast<std::int32_t>(v)); });
  component.relaxation.bound = complete ? graph::total_weight(set, graph)
                                        : std::reduce(graph.weights.begin(), graph.weights.end(), std::int64_t{0});
}

// False if the component is not very dense, or if this takes too long.
bool BranchAndReduce::solve_dense(Component& component, std::int64_t needed) {
  const graph::ConflictGraph& graph = component.graph;
  if (graph.vertex_count() <= least_on_bits || !is_very_dense(graph)) return false;
  needed = std::max<std::int64_t>(needed, 0);
  ground::SearchBudget budget(nodes_on_bits, &deadline_);
  std::optional<graph::IndependentSet> heaviest = search_on_bits(graph, needed, budget);
  if (budget.exhausted()) return false;
  // If there is none that is heavy enough, this bound ends the node.
  component.relaxation.bound = heaviest ? graph::total_weight(*heaviest, graph) : needed;
  component.optimum = heaviest ? std::move(*heaviest) : graph::IndependentSet();
  return true;
}

// Branches: with a vertex, then without it.
std::optional<graph::IndependentSet> BranchAndReduce::branch(const Component& component, std::int64_t needed,
                                                             int depth) {
  const graph::ConflictGraph& graph = component.graph;
  const std::int32_t v = branching_vertex(graph, component.relaxation);
  std::optional<graph::IndependentSet> best;
  const std::vector<std::int32_t> beside = without_neighbourhood(graph, v);
  if (const auto found = reduce(graph::induced_subgraph(graph, beside), needed - graph.weights[v], depth + 1)) {
    best = renumbered(*found, beside);
    best->insert(std::ranges::lower_bound(*best, v), v);
    needed = graph::total_weight(*best, graph);
  }
  std::vector<std::int32_t> others(graph.weights.size());
  std::iota(others.begin(), others.end(), 0);
  others.erase(others.begin() + v);
  if (const auto found = reduce(graph::induced_subgraph(graph, others), needed, depth + 1))
    best = renumbered(*found, others);
  return best;
}

}  // namespace hexpipe::mwis::exact
