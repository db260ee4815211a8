#pragma once
// What is left to search of a conflict graph when exact reductions have decided what they can, and components of the
// kernel that are small enough are solved. Nothing may be left: then the solution is known.

#include <cstdint>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/reduce/kernel.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::local_search {

class Remainder {
 public:
  // Takes a share of the time that is left, all that it wants where there is no limit.
  Remainder(const graph::ConflictGraph& graph, const Deadline& deadline);

  const graph::ConflictGraph& graph() const { return graph_; }
  // lift() of the empty set is optimal.
  bool is_solved() const { return graph_.vertex_count() == 0; }
  // How much heavier a solution of the remainder becomes by lift, at least.
  std::int64_t offset() const { return kernel_.offset() + solved_weight_; }

  // A maximal independent set of the whole graph from one of the remainder.
  graph::IndependentSet lift(const graph::IndependentSet& of_remainder) const;
  // What a set of the whole graph chooses in the remainder; not maximal in general.
  graph::IndependentSet project(const graph::IndependentSet& of_whole) const;
  // The whole graph's numbers of these, without those that reductions made of several vertices.
  std::vector<std::int32_t> originals(std::span<const std::int32_t> of_remainder) const;

 private:
  void solve_components(const Deadline& deadline);
  std::vector<std::int32_t> in_kernel(std::span<const std::int32_t> of_remainder) const;

  reduce::Kernel kernel_;
  graph::ConflictGraph graph_;
  std::vector<std::int32_t> vertices_;  // of the kernel, ascending, by vertex of the remainder
  graph::IndependentSet solved_;        // of the kernel, in components that are solved
  std::int64_t solved_weight_ = 0;
};

}  // namespace hexpipe::mwis::local_search
