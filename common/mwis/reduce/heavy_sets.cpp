#include "common/mwis/reduce/heavy_sets.hpp"

#include <algorithm>

namespace hexpipe::mwis::reduce {

bool HeavySets::find(const ground::DenseGraph& graph, std::int64_t limit, std::size_t most, std::int64_t nodes) {
  graph_ = &graph;
  words_ = graph.words();
  limit_ = limit;
  most_ = most;
  nodes_ = nodes;
  sets_.clear();
  weights_.clear();
  current_.assign(words_, 0);
  candidates_.resize(std::max(candidates_.size(), 2 * words_));
  if (graph.size() == 0) return true;
  bits::fill(candidates_.data(), graph.size());
  return extend(0, 0);
}

// current_ weighs `weight`; the candidates of this depth may be added to it.
bool HeavySets::extend(std::size_t depth, std::int64_t weight) {
  if (--nodes_ < 0) return false;
  if (candidates_.size() < (depth + 3) * words_) candidates_.resize((depth + 3) * words_);
  if (weight <= limit_) {
    bits::Word* const scratch = candidates_.data() + (depth + 1) * words_;
    std::copy_n(candidates_.data() + depth * words_, words_, scratch);
    if (bound_.at_most(*graph_, scratch, limit_ - weight)) return true;
  } else if (depth > 0) {
    if (weights_.size() == most_) return false;
    weights_.push_back(weight);
    sets_.insert(sets_.end(), current_.begin(), current_.end());
  }
  for (std::size_t w = 0; w < words_; ++w)
    while (true) {
      // Deeper levels may have moved the rows.
      bits::Word* const candidates = candidates_.data() + depth * words_;
      if (candidates[w] == 0) break;
      const std::size_t v = 64 * w + static_cast<std::size_t>(std::countr_zero(candidates[w]));
      bits::erase(candidates, v);
      for (std::size_t i = 0; i < words_; ++i) candidates[words_ + i] = candidates[i] & ~graph_->row(v)[i];
      bits::insert(current_.data(), v);
      const bool complete = extend(depth + 1, weight + graph_->weight(v));
      bits::erase(current_.data(), v);
      if (!complete) return false;
    }
  return true;
}

}  // namespace hexpipe::mwis::reduce
