#include "common/mwis/reduce/dense_reductions.hpp"

#include <algorithm>
#include <limits>

namespace hexpipe::mwis::reduce {

void DenseReductions::reduce(ground::DenseGraph& graph) {
  graph_ = &graph;
  words_ = graph.words();
  offset_ = 0;
  decisions_.clear();
  for (auto* set : {&alive_, &touched_, &around_, &scratch_}) set->assign(words_, 0);
  if (graph.size() == 0) return;
  bits::fill(alive_.data(), graph.size());
  bits::fill(touched_.data(), graph.size());
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t w = 0; w < words_; ++w)
      while (touched_[w] != 0) {
        const auto v = static_cast<std::uint32_t>(64 * w + static_cast<std::size_t>(std::countr_zero(touched_[w])));
        bits::erase(touched_.data(), v);
        changed = decide(v) || changed;
      }
  }
}

// Tries every rule at v, the cheap ones first. True if one of them changed the graph.
bool DenseReductions::decide(std::uint32_t v) {
  if (graph_->weight(v) == 0) return drop(v), true;
  const bits::Word* const row = graph_->row(v);
  for (std::size_t w = 0; w < words_; ++w) around_[w] = row[w] & alive_[w];
  std::int64_t neighbour_sum = 0;
  bits::for_each(around_.data(), words_, [&](std::size_t u) { neighbour_sum += graph_->weight(u); });

  if (outweighs_neighbourhood(v, neighbour_sum)) return take(v), true;
  if (neighbourhood_is_clique()) return transfer_weight(v), true;
  if (some_neighbour_replaces(v)) return drop(v), true;
  return drop_common_neighbours(v, neighbour_sum);
}

// Neighbourhood removal: no independent set of neighbours outweighs v.
bool DenseReductions::outweighs_neighbourhood(std::uint32_t v, std::int64_t neighbour_sum) {
  const std::int64_t weight = graph_->weight(v);
  if (neighbour_sum <= weight) return true;
  std::copy_n(around_.data(), words_, scratch_.data());
  return bound_.at_most(*graph_, scratch_.data(), weight);
}

bool DenseReductions::neighbourhood_is_clique() const {
  return bits::all_of(around_.data(), words_, [&](std::size_t u) {
    const bits::Word* const row = graph_->row(u);
    for (std::size_t w = 0; w < words_; ++w) {
      bits::Word missing = around_[w] & ~row[w];
      if (w == u / 64) missing &= ~(bits::Word{1} << (u % 64));
      if (missing != 0) return false;
    }
    return true;
  });
}

// The neighbours of v are a clique, and some are heavier. v is chosen unless one of these is; that one then contributes
// only the difference.
void DenseReductions::transfer_weight(std::uint32_t v) {
  const std::int64_t weight = graph_->weight(v);
  offset_ += weight;
  decisions_.push_back({Step::take_if_free, v});
  bits::erase(alive_.data(), v);
  bits::for_each(around_.data(), words_, [&](std::size_t u) {
    if (graph_->weight(u) <= weight) drop(static_cast<std::uint32_t>(u));
  });
  bits::for_each(around_.data(), words_, [&](std::size_t u) {
    if (!bits::test(alive_.data(), u)) return;
    graph_->set_weight(u, graph_->weight(u) - weight);
    bits::insert(touched_.data(), u);
    touch_neighbours(static_cast<std::uint32_t>(u));
  });
}

// Basic single edge, with domination as a special case: a neighbour u, with what it would push out beside v, weighs at
// least as much as v and that. So v is not needed.
bool DenseReductions::some_neighbour_replaces(std::uint32_t v) {
  const std::int64_t weight = graph_->weight(v);
  const bits::Word* const own = graph_->row(v);
  return !bits::all_of(around_.data(), words_, [&](std::size_t u) {
    const std::int64_t allowance = graph_->weight(u) - weight;
    if (allowance < 0) return true;
    const bits::Word* const row = graph_->row(u);
    for (std::size_t w = 0; w < words_; ++w) scratch_[w] = row[w] & alive_[w] & ~own[w];
    bits::erase(scratch_.data(), v);
    return !bound_.at_most(*graph_, scratch_.data(), allowance);
  });
}

// Extended single edge: if v outweighs its neighbourhood without u, one of the two is chosen, and no common neighbour
// is.
bool DenseReductions::drop_common_neighbours(std::uint32_t v, std::int64_t neighbour_sum) {
  const std::int64_t weight = graph_->weight(v);
  bool changed = false;
  bits::for_each(around_.data(), words_, [&](std::size_t u) {
    if (changed || neighbour_sum - graph_->weight(u) > weight) return;
    const bits::Word* const row = graph_->row(u);
    for (std::size_t w = 0; w < words_; ++w) scratch_[w] = row[w] & around_[w];
    bits::for_each(scratch_.data(), words_, [&](std::size_t common) {
      drop(static_cast<std::uint32_t>(common));
      changed = true;
    });
  });
  if (changed) bits::insert(touched_.data(), v);
  return changed;
}

void DenseReductions::take(std::uint32_t v) {
  offset_ += graph_->weight(v);
  decisions_.push_back({Step::take, v});
  bits::erase(alive_.data(), v);
  bits::for_each(around_.data(), words_, [&](std::size_t u) { drop(static_cast<std::uint32_t>(u)); });
}

void DenseReductions::drop(std::uint32_t v) {
  bits::erase(alive_.data(), v);
  bits::erase(touched_.data(), v);
  touch_neighbours(v);
}

void DenseReductions::touch_neighbours(std::uint32_t v) {
  const bits::Word* const row = graph_->row(v);
  for (std::size_t w = 0; w < words_; ++w) touched_[w] |= row[w] & alive_[w];
}

void DenseReductions::lift(bits::Word* chosen) const {
  for (auto decision = decisions_.rbegin(); decision != decisions_.rend(); ++decision) {
    const std::uint32_t v = decision->vertex;
    const bits::Word* const row = graph_->row(v);
    bool free = true;
    if (decision->step == Step::take_if_free)
      for (std::size_t w = 0; w < words_ && free; ++w) free = (row[w] & chosen[w]) == 0;
    if (free) bits::insert(chosen, v);
  }
}

}  // namespace hexpipe::mwis::reduce
