#pragma once
// The kernel: the graph that exact reductions leave of a whole conflict graph. A solution of the kernel is lifted to
// one of the graph, and an optimal one to an optimal one.

#include <cstdint>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/reduce/reducer.hpp"
#include "common/mwis/reduce/reduction_log.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::reduce {

class Kernel {
 public:
  // Stops at the deadline, with fewer reductions made.
  Kernel(const graph::ConflictGraph& graph, const Deadline& deadline, ReductionEffort effort = ReductionEffort::quick);

  const graph::ConflictGraph& graph() const { return kernel_; }
  // How much heavier a solution of the kernel becomes by the lift: at least this, and exactly this for an optimal one.
  std::int64_t offset() const { return offset_; }

  // A maximal independent set of the graph from one of the kernel.
  graph::IndependentSet lift(const graph::IndependentSet& of_kernel) const;
  // The graph's numbers of these vertices, without those that reductions made of several.
  std::vector<std::int32_t> originals(std::span<const std::int32_t> of_kernel) const;
  // The choice of a set of the graph within the kernel; not maximal in general.
  graph::IndependentSet project(const graph::IndependentSet& of_graph) const;

 private:
  const graph::ConflictGraph& original_;
  graph::ConflictGraph kernel_;
  std::vector<std::int32_t>
      vertices_;             // by vertex of the kernel: the vertex of the graph, or one created by reductions
  std::size_t choices_ = 0;  // vertices of the graph and created ones
  ReductionLog log_;
  std::int64_t offset_ = 0;
};

}  // namespace hexpipe::mwis::reduce
