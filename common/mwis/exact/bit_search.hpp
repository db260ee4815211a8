#pragma once
// The common part of the searches on bits: a row of candidates for each depth, the current set, and the best set.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mwis/ground/dense_graph.hpp"
#include "common/mwis/ground/search_budget.hpp"

namespace hexpipe::mwis::exact {

// Reuses its memory for the next graph.
class BitSearch {
 public:
  // Valid after a search that found a set. The vertices are in no particular order.
  std::span<const std::uint32_t> best() const { return best_; }
  std::int64_t best_weight() const { return best_weight_; }

 protected:
  // Each depth has `rows` rows of bits; the first row holds the candidates.
  explicit BitSearch(std::size_t rows) : rows_(rows) {}

  // At depth 0, all vertices are candidates. Only sets heavier than `lower_bound` count.
  void begin(const ground::DenseGraph& graph, std::int64_t lower_bound, ground::SearchBudget& budget) {
    graph_ = &graph;
    budget_ = &budget;
    words_ = graph.words();
    best_weight_ = lower_bound;
    found_ = false;
    current_.clear();
    if (levels_.size() < rows_ * words_ * (graph.size() + 1)) levels_.resize(rows_ * words_ * (graph.size() + 1));
    if (graph.size() > 0) bits::fill(row(0, 0), graph.size());
  }

  bits::Word* row(std::size_t depth, std::size_t which) { return levels_.data() + (rows_ * depth + which) * words_; }

  // Adds v to the current set. The candidates of the next depth are those of this depth that do not conflict with v.
  void enter(std::size_t v, std::size_t depth) {
    const bits::Word* const candidates = row(depth, 0);
    const bits::Word* const neighbours = graph_->row(v);
    bits::Word* const next = row(depth + 1, 0);
    for (std::size_t i = 0; i < words_; ++i) next[i] = candidates[i] & ~neighbours[i];
    current_.push_back(static_cast<std::uint32_t>(v));
  }
  void leave() { current_.pop_back(); }

  // Makes the current set, which weighs `weight`, the best one if it is heavier.
  void offer(std::int64_t weight) {
    if (weight <= best_weight_) return;
    best_weight_ = weight;
    best_.assign(current_.begin(), current_.end());
    found_ = true;
  }

  const ground::DenseGraph* graph_ = nullptr;
  ground::SearchBudget* budget_ = nullptr;
  std::size_t words_ = 0;
  std::int64_t best_weight_ = 0;
  bool found_ = false;

 private:
  std::size_t rows_;
  std::vector<bits::Word> levels_;
  std::vector<std::uint32_t> current_, best_;
};

}  // namespace hexpipe::mwis::exact
