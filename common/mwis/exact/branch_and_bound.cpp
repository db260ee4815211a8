#include "common/mwis/exact/branch_and_bound.hpp"

#include <algorithm>

namespace hexpipe::mwis::exact {

bool BranchAndBound::solve(const ground::DenseGraph& graph, std::int64_t lower_bound, ground::SearchBudget& budget) {
  begin(graph, lower_bound, budget);
  clique_candidates_.resize(words_);
  residual_.resize(graph.size());
  expand(0, 0);
  return found_;
}

// The candidates of this depth may still be added to the current set, which weighs `weight`.
void BranchAndBound::expand(std::size_t depth, std::int64_t weight) {
  if (!budget_->spend()) return;
  bits::Word* const candidates = row(depth, 0);
  bits::Word* const branches = row(depth, 1);
  if (bits::empty(candidates, words_)) return offer(weight);
  find_branches(candidates, branches, best_weight_ - weight);

  // A branch excludes the branches after it. The cover reached the last ones last; their subtrees are smallest if they
  // go first.
  for (std::size_t w = words_; w-- > 0;)
    while (branches[w] != 0) {
      const std::size_t v = 64 * w + 63 - static_cast<std::size_t>(std::countl_zero(branches[w]));
      bits::erase(branches, v);
      bits::erase(candidates, v);
      enter(v, depth);
      expand(depth + 1, weight + graph_->weight(v));
      leave();
      if (budget_->exhausted()) return;
    }
}

// Leaves in `branches` the candidates that a weighted clique cover of total weight at most `allowance` does not cover
// fully. Any set of candidates heavier than `allowance` has one of them.
void BranchAndBound::find_branches(const bits::Word* candidates, bits::Word* branches, std::int64_t allowance) {
  std::copy_n(candidates, words_, branches);
  if (allowance < 0) return;
  bits::for_each(candidates, words_, [&](std::size_t v) { residual_[v] = graph_->weight(v); });
  for (std::size_t w = 0; w < words_; ++w)
    while (branches[w] != 0) {
      const std::size_t v = 64 * w + static_cast<std::size_t>(std::countr_zero(branches[w]));
      const std::int64_t step = take_clique(branches, w, v, allowance);
      if (step < 0) return;
      allowance -= step;
    }
}

// Builds a clique of uncovered vertices around `first` and subtracts the least residual weight from all its members.
// Returns this weight, or -1 if it exceeds the allowance.
std::int64_t BranchAndBound::take_clique(bits::Word* uncovered, std::size_t first_word, std::size_t first,
                                         std::int64_t allowance) {
  clique_.assign(1, static_cast<std::uint32_t>(first));
  std::int64_t least = residual_[first];
  bits::Word* const open = clique_candidates_.data();
  const bits::Word* const neighbours = graph_->row(first);
  for (std::size_t i = first_word; i < words_; ++i) open[i] = uncovered[i] & neighbours[i];
  for (std::size_t w = first_word; w < words_; ++w)
    while (open[w] != 0) {
      const std::size_t v = 64 * w + static_cast<std::size_t>(std::countr_zero(open[w]));
      clique_.push_back(static_cast<std::uint32_t>(v));
      least = std::min(least, residual_[v]);
      const bits::Word* const other = graph_->row(v);
      for (std::size_t i = w; i < words_; ++i) open[i] &= other[i];
    }
  if (least > allowance) return -1;
  for (const std::uint32_t v : clique_)
    if ((residual_[v] -= least) == 0) bits::erase(uncovered, v);
  return least;
}

}  // namespace hexpipe::mwis::exact
