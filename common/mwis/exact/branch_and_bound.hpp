#pragma once
// Branch and bound for small graphs (Verhetsel 2017, 3.2, algorithms 2 and 4). The bound of a node is a weighted clique
// cover with weight splitting (Babel 1994; Held, Cook, Sewell 2012). Unlike there, the cover also chooses the branches,
// as Jiang, Li, Liu, Manyà 2018 do for cliques: vertices covered within the missing weight need no branch of their own.

#include <cstdint>
#include <vector>

#include "common/mwis/exact/bit_search.hpp"

namespace hexpipe::mwis::exact {

class BranchAndBound : public BitSearch {
 public:
  BranchAndBound() : BitSearch(2) {}

  // Looks for the heaviest independent set among those heavier than `lower_bound`. True if one was found; it is then
  // best(). If budget.exhausted() afterwards, there may be a heavier one; otherwise there is none.
  bool solve(const ground::DenseGraph& graph, std::int64_t lower_bound, ground::SearchBudget& budget);

 private:
  void expand(std::size_t depth, std::int64_t weight);
  void find_branches(const bits::Word* candidates, bits::Word* branches, std::int64_t allowance);
  std::int64_t take_clique(bits::Word* uncovered, std::size_t first_word, std::size_t first, std::int64_t allowance);

  std::vector<bits::Word> clique_candidates_;
  std::vector<std::uint32_t> clique_;
  std::vector<std::int64_t> residual_;
};

}  // namespace hexpipe::mwis::exact
