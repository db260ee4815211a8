#include "common/mwis/exact/historical/complete_search.hpp"

namespace hexpipe::mwis::exact::historical {

bool CompleteSearch::solve(const ground::DenseGraph& graph, std::int64_t lower_bound, ground::SearchBudget& budget) {
  begin(graph, lower_bound, budget);
  expand(0, 0);
  return found_;
}

// The candidates of this depth may be added to the current set, which weighs `weight`.
void CompleteSearch::expand(std::size_t depth, std::int64_t weight) {
  if (!budget_->spend()) return;
  offer(weight);
  bits::Word* const candidates = row(depth, 0);
  for (std::size_t w = 0; w < words_; ++w)
    while (candidates[w] != 0 && !budget_->exhausted()) {
      const std::size_t v = 64 * w + static_cast<std::size_t>(std::countr_zero(candidates[w]));
      bits::erase(candidates, v);
      enter(v, depth);
      expand(depth + 1, weight + graph_->weight(v));
      leave();
    }
}

}  // namespace hexpipe::mwis::exact::historical
