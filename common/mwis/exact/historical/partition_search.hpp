#pragma once
// Branch and bound by greedy clique partition (Verhetsel 2017, 3.2, algorithms 2 and 3): complete search, but it skips
// nodes whose candidates are too light. A partition into cliques, counted by their heaviest vertices, shows that.

#include "common/mwis/bounds/clique_cover_bound.hpp"
#include "common/mwis/exact/bit_search.hpp"

namespace hexpipe::mwis::exact::historical {

class PartitionSearch : public BitSearch {
 public:
  PartitionSearch() : BitSearch(2) {}

  // The same contract as BranchAndBound::solve.
  bool solve(const ground::DenseGraph& graph, std::int64_t lower_bound, ground::SearchBudget& budget);

 private:
  void expand(std::size_t depth, std::int64_t weight);
  bool is_too_light(std::size_t depth, std::int64_t weight);

  bounds::CliqueCoverBound bound_;
};

}  // namespace hexpipe::mwis::exact::historical
