#pragma once
// A conflict graph that reductions change: vertices go, and new ones come for joint decisions.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::mwis::reduce {

class ReducibleGraph {
 public:
  explicit ReducibleGraph(const graph::ConflictGraph& graph);

  // The number of vertices that are or were there; numbers are never reused.
  std::int32_t vertex_count() const { return static_cast<std::int32_t>(weights_.size()); }
  std::int32_t alive_count() const { return alive_count_; }
  bool alive(std::int32_t v) const { return alive_[v] != 0; }
  std::int64_t weight(std::int32_t v) const { return weights_[v]; }
  // The neighbours of an existing vertex, ascending. Valid until a vertex is added.
  std::span<const std::int32_t> neighbours_of(std::int32_t v) {
    if (stale_[v] != 0) refresh(v);
    return {pool_.data() + lists_[v].begin, static_cast<std::size_t>(lists_[v].size)};
  }

  void remove(std::int32_t v);
  // `neighbours` must ascend without repeats.
  std::int32_t add(std::int64_t weight, std::span<const std::int32_t> neighbours);

  // Everything after mark() can be undone at once by rollback(), until the next mark().
  void mark();
  void rollback();

  // The remaining graph, renumbered in ascending order of its vertices; `vertices` gets their numbers here.
  graph::ConflictGraph compress(std::vector<std::int32_t>& vertices);

 private:
  struct List {
    std::int64_t begin, size, capacity;  // in pool_
  };
  void refresh(std::int32_t v);
  void append(std::int32_t v, std::int32_t neighbour);
  void move_to_end(std::int32_t v, std::int64_t capacity);
  void pack();

  std::vector<std::int64_t> weights_;
  std::vector<List> lists_;
  std::vector<std::int32_t> pool_;
  std::vector<char> alive_, stale_;  // a stale list names vertices that are gone
  std::int32_t alive_count_;

  // Since mark(), lists change only behind marked_end_; earlier lists are copied there first.
  std::int64_t marked_end_ = 0;
  std::int32_t marked_vertices_ = 0, marked_alive_ = 0;
  std::vector<std::int32_t> removed_;
  std::vector<std::pair<std::int32_t, List>> moved_;
  std::size_t packed_size_;  // of the pool when it had no holes
};

}  // namespace hexpipe::mwis::reduce
