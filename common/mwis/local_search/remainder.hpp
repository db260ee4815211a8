#pragma once
// The graph that is left to search when exact reductions have decided what they can and small components of the kernel
// are solved. It may be empty: then the solution is known.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/reduce/kernel.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::local_search {

class Remainder {
 public:
  // Reduces the graph, in a share of the time that is left, or as long as it takes if there is no limit. A large graph
  // with many conflicts is left as it is if a sample shows that reductions decide few of its vertices. `graph` must
  // outlive the remainder.
  Remainder(const graph::ConflictGraph& graph, const Deadline& deadline);
  Remainder(const Remainder&) = delete;
  Remainder& operator=(const Remainder&) = delete;

  const graph::ConflictGraph& graph() const { return is_whole_ ? kernel() : graph_; }
  // Whether lift() of the empty set is optimal.
  bool is_solved() const { return graph().vertex_count() == 0; }
  // lift() makes a set heavier by at least this.
  std::int64_t offset() const { return (kernel_ ? kernel_->offset() : 0) + solved_weight_; }

  // A maximal independent set of the whole graph from one of the remainder.
  graph::IndependentSet lift(const graph::IndependentSet& of_remainder) const;
  // What a set of the whole graph chooses within the remainder; not maximal in general.
  graph::IndependentSet project(const graph::IndependentSet& of_whole) const;
  // The whole graph's numbers of these vertices, without those that reductions made of several.
  std::vector<std::int32_t> originals(std::span<const std::int32_t> of_remainder) const;

 private:
  const graph::ConflictGraph& kernel() const { return kernel_ ? kernel_->graph() : whole_; }
  void solve_components(const Deadline& deadline);
  std::vector<std::int32_t> in_kernel(std::span<const std::int32_t> of_remainder) const;

  const graph::ConflictGraph& whole_;
  std::optional<reduce::Kernel> kernel_;  // none: nothing was reduced, and `kernel` means the whole graph
  bool is_whole_ = false;                 // no component of the kernel was solved; there is no copy of it then
  graph::ConflictGraph graph_;
  std::vector<std::int32_t> vertices_;  // by vertex of graph_: its number in the kernel, ascending
  graph::IndependentSet solved_;        // in the kernel, of the components that are solved
  std::int64_t solved_weight_ = 0;
};

}  // namespace hexpipe::mwis::local_search
