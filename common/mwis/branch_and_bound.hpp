#pragma once
// Branch and bound for small graphs (Verhetsel 2017, 3.2, algorithms 2 and 4): the bound of a node is a weighted clique
// cover with weight splitting (Babel 1994; Held, Cook, Sewell 2012). Deviates in using the cover for the choice of
// branches too, as Jiang, Li, Liu, Manyà 2018 do for cliques: what a cover of no more than the missing weight covers
// needs no branch of its own.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mwis/dense_graph.hpp"
#include "common/mwis/search_budget.hpp"

namespace hexpipe {

// Keeps its memory from one graph to the next.
class BranchAndBound {
 public:
  // Looks for the heaviest independent set among those heavier than `lower_bound`; true when one was found, which is
  // then best(). With budget.exhausted() afterwards there may be a heavier one, otherwise there is none.
  bool solve(const DenseGraph& graph, std::int64_t lower_bound, SearchBudget& budget);

  // Valid after solve() returned true; vertices in no particular order.
  std::span<const std::uint32_t> best() const { return best_; }
  std::int64_t best_weight() const { return best_weight_; }

 private:
  struct Level {
    bits::Word* candidates;
    bits::Word* branches;
  };
  Level level(std::size_t depth);
  void expand(std::size_t depth, std::int64_t weight);
  void find_branches(const bits::Word* candidates, bits::Word* branches, std::int64_t allowance);
  std::int64_t take_clique(bits::Word* uncovered, std::size_t first_word, std::size_t first, std::int64_t allowance);
  void offer(std::int64_t weight);

  const DenseGraph* graph_ = nullptr;
  SearchBudget* budget_ = nullptr;
  std::size_t words_ = 0;
  std::vector<bits::Word> levels_;
  std::vector<bits::Word> clique_candidates_;
  std::vector<std::uint32_t> clique_;
  std::vector<std::int64_t> residual_;
  std::vector<std::uint32_t> current_, best_;
  std::int64_t best_weight_ = 0;
  bool found_ = false;
};

}  // namespace hexpipe
