#pragma once
// Complete search (Verhetsel 2017, 3.2, algorithm 1) tries every independent set; the other algorithms are measured
// against it. Branch and bound by greedy clique partition (algorithms 2 and 3) does the same, but skips nodes whose
// candidates are too light: a partition into cliques, counted by their heaviest vertices, shows that.

#include "common/mwis/bounds/clique_cover_bound.hpp"
#include "common/mwis/exact/bit_search.hpp"

namespace hexpipe::mwis::exact::historical {

enum class NodeBound { none, clique_partition };

template <NodeBound bound>
class EnumerativeSearch : public BitSearch {
 public:
  EnumerativeSearch() : BitSearch(bound == NodeBound::none ? 1 : 2) {}

  // The same contract as BranchAndBound::solve.
  bool solve(const ground::DenseGraph& graph, std::int64_t lower_bound, ground::SearchBudget& budget);

 private:
  void expand(std::size_t depth, std::int64_t weight);
  bool is_too_light(std::size_t depth, std::int64_t weight);

  bounds::CliqueCoverBound bound_;
};

using CompleteSearch = EnumerativeSearch<NodeBound::none>;
using PartitionSearch = EnumerativeSearch<NodeBound::clique_partition>;

}  // namespace hexpipe::mwis::exact::historical
