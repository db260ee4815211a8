#pragma once
// The heaviest independent set of a small graph: reductions, then branch and bound on each connected component that
// they leave, then the lift.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mwis/exact/branch_and_bound.hpp"
#include "common/mwis/ground/dense_graph.hpp"
#include "common/mwis/ground/search_budget.hpp"
#include "common/mwis/reduce/dense_reductions.hpp"

namespace hexpipe::mwis::exact {

// Reuses its memory for the next graph.
class ExactSolver {
 public:
  // `chosen` (one word per 64 vertices) holds an independent set; it is replaced by one that is not lighter. True if
  // that one is proven to be the heaviest, false if the budget ran out before. The weights of `graph` are used up.
  bool solve(ground::DenseGraph& graph, std::span<bits::Word> chosen, ground::SearchBudget& budget);

 private:
  void find_components(const ground::DenseGraph& graph);
  std::int64_t solve_component(const ground::DenseGraph& graph, std::span<const std::uint32_t> component,
                               std::int64_t needed, ground::SearchBudget& budget);
  void extract(const ground::DenseGraph& graph, std::span<const std::uint32_t> component);
  std::int64_t complete_warm_start();

  reduce::DenseReductions reductions_;
  BranchAndBound branch_and_bound_;
  ground::DenseGraph component_;         // the component that is being solved
  std::vector<std::uint32_t> vertices_;  // of all components, one after another
  std::vector<std::size_t> ends_;        // of each component in vertices_
  std::vector<std::uint32_t> order_;     // the graph's vertex for each vertex of component_
  std::vector<bits::Word> unseen_, covered_, warm_, solution_;
  std::vector<double> crowding_;
};

}  // namespace hexpipe::mwis::exact
