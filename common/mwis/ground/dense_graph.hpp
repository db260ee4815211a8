#pragma once
// A small graph as a bit matrix. Branch and bound and the reductions of fragments work on it.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/ground/bits.hpp"

namespace hexpipe::mwis::ground {

// Keeps its memory when it is reset to a smaller graph.
class DenseGraph {
 public:
  DenseGraph() = default;
  explicit DenseGraph(std::size_t vertices) { reset(vertices); }

  // Resets to `vertices` vertices of weight 0 without edges.
  void reset(std::size_t vertices) {
    words_ = bits::words_for(vertices);
    weights_.assign(vertices, 0);
    rows_.assign(vertices * words_, 0);
  }

  std::size_t size() const { return weights_.size(); }
  // The number of words in a row.
  std::size_t words() const { return words_; }
  const bits::Word* row(std::size_t v) const { return rows_.data() + v * words_; }
  bits::Word* row(std::size_t v) { return rows_.data() + v * words_; }
  std::int64_t weight(std::size_t v) const { return weights_[v]; }
  void set_weight(std::size_t v, std::int64_t weight) { weights_[v] = weight; }
  std::span<const std::int64_t> weights() const { return weights_; }

  bool has_edge(std::size_t a, std::size_t b) const { return bits::test(row(a), b); }
  void add_edge(std::size_t a, std::size_t b) {
    bits::insert(row(a), b);
    bits::insert(row(b), a);
  }

 private:
  std::size_t words_ = 0;
  std::vector<std::int64_t> weights_;
  std::vector<bits::Word> rows_;
};

// The same graph with the same vertex numbers.
DenseGraph dense_graph_of(const graph::ConflictGraph& graph);

}  // namespace hexpipe::mwis::ground
