#include "common/mwis/reduce/kernel.hpp"

#include "common/mwis/ground/solution_state.hpp"

namespace hexpipe::mwis::reduce {

Kernel::Kernel(const graph::ConflictGraph& graph, const Deadline& deadline, ReductionEffort effort) : original_(graph) {
  Reducer reducer(graph, log_);
  offset_ = reducer.run(effort, deadline);
  choices_ = static_cast<std::size_t>(reducer.graph().vertex_count());
  kernel_ = reducer.graph().compress(vertices_);
}

graph::IndependentSet Kernel::lift(const graph::IndependentSet& of_kernel) const {
  std::vector<std::uint8_t> chosen(choices_, 0);
  for (const std::int32_t v : of_kernel) chosen[vertices_[v]] = 1;
  log_.lift(chosen);
  ground::SolutionState state(original_);
  for (std::int32_t v = 0; v < original_.vertex_count(); ++v)
    if (chosen[v] != 0) state.add(v);
  state.make_maximal();
  return state.to_set();
}

std::vector<std::int32_t> Kernel::originals(std::span<const std::int32_t> of_kernel) const {
  std::vector<std::int32_t> result;
  result.reserve(of_kernel.size());
  for (const std::int32_t v : of_kernel)
    if (vertices_[v] < original_.vertex_count()) result.push_back(vertices_[v]);
  return result;
}

graph::IndependentSet Kernel::project(const graph::IndependentSet& of_graph) const {
  std::vector<std::uint8_t> chosen(choices_, 0);
  for (const std::int32_t v : of_graph) chosen[v] = 1;
  log_.project(chosen);
  graph::IndependentSet of_kernel;
  for (std::int32_t v = 0; v < kernel_.vertex_count(); ++v)
    if (chosen[vertices_[v]] != 0) of_kernel.push_back(v);
  return of_kernel;
}

}  // namespace hexpipe::mwis::reduce
