#include "common/mwis/ground/solution_state.hpp"

#include <algorithm>
#include <cassert>

namespace hexpipe::mwis::ground {

SolutionState::SolutionState(const graph::ConflictGraph& graph)
    : graph_(&graph), around_(graph.weights.size()), chosen_(graph.weights.size(), 0) {
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) around_[v].push_gain = graph.weights[v];
}

SolutionState::SolutionState(const graph::ConflictGraph& graph, const graph::IndependentSet& solution)
    : SolutionState(graph) {
  for (const std::int32_t v : solution) add(v);
}

void SolutionState::add(std::int32_t v) {
  assert(!contains(v) && tightness(v) == 0);
  const std::int64_t weight = graph_->weights[v];
  chosen_[v] = 1;
  weight_ += weight;
  for (const std::int32_t u : graph_->neighbours_of(v)) {
    Around& around = around_[u];
    around.push_gain -= weight;
    ++around.tightness;
    around.number_sum += static_cast<std::uint32_t>(v);
  }
}

void SolutionState::make_maximal() {
  std::vector<std::int32_t> free;
  for (std::int32_t v = 0; v < graph_->vertex_count(); ++v)
    if (!contains(v) && tightness(v) == 0) free.push_back(v);
  std::ranges::stable_sort(free,
                           [&](std::int32_t a, std::int32_t b) { return graph_->weights[a] > graph_->weights[b]; });
  for (const std::int32_t v : free)
    if (tightness(v) == 0) add(v);
}

graph::IndependentSet SolutionState::to_set() const {
  graph::IndependentSet solution;
  for (std::int32_t v = 0; v < graph_->vertex_count(); ++v)
    if (contains(v)) solution.push_back(v);
  return solution;
}

bool SolutionState::check() const {
  SolutionState fresh(*graph_);
  for (std::int32_t v = 0; v < graph_->vertex_count(); ++v) {
    if (!contains(v)) continue;
    if (fresh.tightness(v) != 0) return false;
    fresh.add(v);
  }
  return fresh.around_ == around_ && fresh.weight_ == weight_;
}

}  // namespace hexpipe::mwis::ground
