#pragma once
// Exact reductions of a whole conflict graph: what can be decided without search is decided, and a solution of the
// kernel that is left is lifted to one of the graph, an optimal one to an optimal one. The rules are those of Lamm et
// al. 2019 and Gu et al. 2021, read from the centre of a neighbourhood; where these add up weights, we bound by a
// clique cover, because the conflicts of cells come in cliques.

#include <cstdint>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe {

class Kernel {
 public:
  // Stops at the deadline, with less reduced.
  Kernel(const ConflictGraph& graph, const Deadline& deadline);

  const ConflictGraph& graph() const { return kernel_; }
  // How much heavier a solution of the kernel becomes by lift, at least; an optimal one exactly.
  std::int64_t offset() const { return offset_; }

  // A maximal independent set of the graph from one of the kernel.
  IndependentSet lift(const IndependentSet& of_kernel) const;
  // What a set of the graph chooses in the kernel; not maximal in general.
  IndependentSet project(const IndependentSet& of_graph) const;

 private:
  friend class Reducer;
  enum class Step : std::uint8_t { take, take_if_free };
  struct Decision {
    Step step;
    std::int32_t vertex;
  };

  const ConflictGraph& original_;
  ConflictGraph kernel_;
  std::vector<std::int32_t> vertices_;  // of the graph, by vertex of the kernel
  std::vector<Decision> decisions_;
  std::int64_t offset_ = 0;
};

}  // namespace hexpipe
