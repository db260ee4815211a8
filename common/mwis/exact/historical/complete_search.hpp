#pragma once
// Complete search (Verhetsel 2017, 3.2, algorithm 1): tries every independent set. The other algorithms are measured
// against it.

#include "common/mwis/exact/bit_search.hpp"

namespace hexpipe::mwis::exact::historical {

class CompleteSearch : public BitSearch {
 public:
  CompleteSearch() : BitSearch(1) {}

  // The same contract as BranchAndBound::solve.
  bool solve(const ground::DenseGraph& graph, std::int64_t lower_bound, ground::SearchBudget& budget);

 private:
  void expand(std::size_t depth, std::int64_t weight);
};

}  // namespace hexpipe::mwis::exact::historical
