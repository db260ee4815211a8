#include "common/mwis/reduce/heavy_sets.hpp"

#include <algorithm>

namespace hexpipe::mwis::reduce {

bool HeavySets::find(const ground::DenseGraph& graph, std::int64_t limit, std::size_t most, std::int64_t nodes) {
  graph_ = &graph;
  words_ = graph.words();
  limit_ = limit;
  most_ = most;
  nodes_ = nodes - 1;
  count_ = 0;
  sets_.resize(std::max(sets_.size(), most * words_));
  weights_.resize(std::max(weights_.size(), most));
  current_.assign(words_, 0);
  candidates_.resize(std::max(candidates_.size(), (graph.size() + 1) * words_));
  if (graph.size() == 0) return true;
  if (nodes_ < 0) return false;
  bits::fill(candidates_.data(), graph.size());
  // Neighbourhoods that are folded nearly always have one or two words.
  return words_ == 1 ? extend<1>(0, 0) : words_ == 2 ? extend<2>(0, 0) : extend<0>(0, 0);
}

template <std::size_t Words>
bool HeavySets::extend(std::size_t depth, std::int64_t weight) {
  const std::size_t words = Words == 0 ? words_ : Words;
  bits::Word* const candidates = candidates_.data() + depth * words;
  bits::Word* const next = candidates + words;
  if (weight <= limit_) {
    std::copy_n(candidates, words, next);
    if (bound_.at_most(*graph_, next, limit_ - weight)) return true;
  }
  for (std::size_t w = 0; w < words; ++w)
    while (candidates[w] != 0) {
      const std::size_t v = 64 * w + static_cast<std::size_t>(std::countr_zero(candidates[w]));
      bits::erase(candidates, v);
      if (--nodes_ < 0) return false;
      const bits::Word* const row = graph_->row(v);
      bits::Word any = 0;
      for (std::size_t i = 0; i < words; ++i) any |= next[i] = candidates[i] & ~row[i];
      const std::int64_t with_v = weight + graph_->weight(v);
      bits::insert(current_.data(), v);
      if (with_v > limit_) {
        if (count_ == most_) return false;
        weights_[count_] = with_v;
        for (std::size_t i = 0; i < words; ++i) sets_[count_ * words + i] = current_[i];
        ++count_;
      }
      if (any != 0 && !extend<Words>(depth + 1, with_v)) return false;
      bits::erase(current_.data(), v);
    }
  return true;
}

}  // namespace hexpipe::mwis::reduce
