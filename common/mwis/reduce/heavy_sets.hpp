#pragma once
// All independent sets of a small graph that are heavier than a limit: a vertex has to compete with those in its
// neighbourhood.

#include <cstdint>
#include <vector>

#include "common/mwis/bounds/clique_cover_bound.hpp"
#include "common/mwis/ground/dense_graph.hpp"

namespace hexpipe::mwis::reduce {

// Reuses its memory for the next graph.
class HeavySets {
 public:
  // True if all sets heavier than `limit` were found; false if there are more than `most`, or if the search takes more
  // than `nodes`.
  bool find(const ground::DenseGraph& graph, std::int64_t limit, std::size_t most, std::int64_t nodes);

  std::size_t size() const { return count_; }
  const bits::Word* set(std::size_t i) const { return sets_.data() + i * words_; }
  std::int64_t weight(std::size_t i) const { return weights_[i]; }

 private:
  // current_ weighs `weight`; the candidates of this depth, of `Words` words (0: any number), may be added to it.
  template <std::size_t Words>
  bool extend(std::size_t depth, std::int64_t weight);

  const ground::DenseGraph* graph_ = nullptr;
  std::size_t words_ = 0;
  std::int64_t limit_ = 0;
  std::size_t most_ = 0;
  std::int64_t nodes_ = 0;
  std::size_t count_ = 0;  // the sets found; there is room for most_
  std::vector<bits::Word> sets_;
  std::vector<std::int64_t> weights_;
  std::vector<bits::Word> candidates_;  // a row for each depth, and one for bounds
  std::vector<bits::Word> current_;
  bounds::CliqueCoverBound bound_;
};

}  // namespace hexpipe::mwis::reduce
