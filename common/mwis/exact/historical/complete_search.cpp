#include "common/mwis/exact/historical/complete_search.hpp"

#include <algorithm>

namespace hexpipe::mwis::exact::historical {

template <NodeBound bound>
bool EnumerativeSearch<bound>::solve(const ground::DenseGraph& graph, std::int64_t lower_bound,
                                     ground::SearchBudget& budget) {
  begin(graph, lower_bound, budget);
  expand(0, 0);
  return found_;
}

// The candidates of this depth may be added to the current set, which weighs `weight`. A bound holds for the candidates
// that are left, so it is computed again for each.
template <NodeBound bound>
void EnumerativeSearch<bound>::expand(std::size_t depth, std::int64_t weight) {
  if (!budget_->spend()) return;
  offer(weight);
  bits::Word* const candidates = row(depth, 0);
  for (std::size_t w = 0; w < words_; ++w)
    while (candidates[w] != 0 && !budget_->exhausted()) {
      if (is_too_light(depth, weight)) return;
      const std::size_t v = 64 * w + static_cast<std::size_t>(std::countr_zero(candidates[w]));
      bits::erase(candidates, v);
      enter(v, depth);
      expand(depth + 1, weight + graph_->weight(v));
      leave();
    }
}

template <NodeBound bound>
bool EnumerativeSearch<bound>::is_too_light(std::size_t depth, std::int64_t weight) {
  if (bound == NodeBound::none || weight > best_weight_) return false;
  bits::Word* const scratch = row(depth, 1);
  std::copy_n(row(depth, 0), words_, scratch);
  return bound_.at_most(*graph_, scratch, best_weight_ - weight);
}

template class EnumerativeSearch<NodeBound::none>;
template class EnumerativeSearch<NodeBound::clique_partition>;

}  // namespace hexpipe::mwis::exact::historical
