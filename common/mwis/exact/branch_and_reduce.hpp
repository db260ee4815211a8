#pragma once
// The heaviest independent set of a large sparse graph, with proof: branch and reduce (Lamm et al. 2019). A node is
// reduced and cut into connected components. A relaxation bounds each component, and its reduced costs decide more
// vertices (Verhetsel 2017, 3.2). Branch and bound on bits solves small ones, and tries dense ones first. Unlike there,
// each component is bounded by what the others may still reach.

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/bounds/relaxation.hpp"
#include "common/mwis/exact/exact_solver.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::exact {

// The result of an exact search for a set heavier than a given weight.
struct ExactResult {
  std::optional<graph::IndependentSet> better;  // the heaviest set found, if it is heavier than that weight
  bool complete = false;                        // whether it, or that there is none, is proven
  std::int64_t bound = 0;                       // on every set; if complete, the optimum or that weight
  std::int64_t nodes = 0;
};

class BranchAndReduce {
 public:
  // Branch and bound on bits solves components of at most `small` vertices.
  BranchAndReduce(bounds::Relax relax, const Deadline& deadline, std::int32_t small = 100)
      : relax_(std::move(relax)), deadline_(deadline), small_(small) {}

  // The heaviest set among those heavier than `needed`. Nothing if there is no such set, or if the deadline passed
  // before one was found.
  std::optional<graph::IndependentSet> solve(const graph::ConflictGraph& graph, std::int64_t needed);

  // True if the deadline did not pass: the result of solve() is proven.
  bool complete() const { return !stopped_; }
  std::int64_t nodes() const { return nodes_; }
  // A bound on every set, from before the first branch; if the deadline passed before that, the sum of all weights.
  std::int64_t bound() const { return bound_; }

 private:
  struct Component;
  std::optional<graph::IndependentSet> reduce(const graph::ConflictGraph& graph, std::int64_t needed, int depth);
  std::vector<Component> bound_components(const graph::ConflictGraph& graph, std::int64_t needed, int depth);
  std::optional<graph::IndependentSet> solve_components(const graph::ConflictGraph& graph, std::int64_t needed,
                                                        int depth);
  std::optional<graph::IndependentSet> solve_component(const Component& component, std::int64_t needed, int depth);
  void solve_small(Component& component);
  bool solve_dense(Component& component, std::int64_t needed);
  std::optional<graph::IndependentSet> branch(const Component& component, std::int64_t needed, int depth);
  bool stop();

  bounds::Relax relax_;
  const Deadline& deadline_;
  std::int32_t small_;
  ExactSolver small_solver_;
  bool stopped_ = false;
  std::int64_t nodes_ = 0;
  std::int64_t bound_ = 0;
  std::int64_t offset_ = 0;  // of the reductions before the first branch
};

}  // namespace hexpipe::mwis::exact
