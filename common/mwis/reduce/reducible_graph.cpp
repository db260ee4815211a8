#include "common/mwis/reduce/reducible_graph.hpp"

#include <algorithm>

namespace hexpipe::mwis::reduce {

ReducibleGraph::ReducibleGraph(const graph::ConflictGraph& graph)
    : weights_(graph.weights),
      pool_(graph.neighbours),
      alive_(graph.weights.size(), 1),
      stale_(graph.weights.size(), 0),
      alive_count_(graph.vertex_count()),
      packed_size_(graph.neighbours.size()) {
  lists_.reserve(graph.weights.size());
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
    lists_.push_back({graph.offsets[v], graph.degree(v), graph.degree(v)});
}

// Leaves those that are gone out of the list.
void ReducibleGraph::refresh(std::int32_t v) {
  stale_[v] = 0;
  if (lists_[v].begin < marked_end_) move_to_end(v, lists_[v].size);
  const auto begin = pool_.begin() + lists_[v].begin;
  const auto end = std::remove_if(begin, begin + lists_[v].size, [&](std::int32_t u) { return alive_[u] == 0; });
  lists_[v].size = end - begin;
}

void ReducibleGraph::remove(std::int32_t v) {
  alive_[v] = 0;
  --alive_count_;
  removed_.push_back(v);
  for (const std::int32_t u : neighbours_of(v)) stale_[u] = 1;
}

std::int32_t ReducibleGraph::add(std::int64_t weight, std::span<const std::int32_t> neighbours) {
  const std::int32_t v = vertex_count();
  const auto degree = static_cast<std::int64_t>(neighbours.size());
  lists_.push_back({static_cast<std::int64_t>(pool_.size()), degree, degree});
  pool_.insert(pool_.end(), neighbours.begin(), neighbours.end());
  weights_.push_back(weight);
  alive_.push_back(1);
  stale_.push_back(0);
  ++alive_count_;
  for (const std::int32_t u : neighbours) append(u, v);
  return v;
}

// New vertices have the highest numbers, so lists stay ascending.
void ReducibleGraph::append(std::int32_t v, std::int32_t neighbour) {
  if (stale_[v] != 0) refresh(v);
  if (lists_[v].size == lists_[v].capacity || lists_[v].begin < marked_end_) move_to_end(v, 2 * lists_[v].size + 4);
  pool_[lists_[v].begin + lists_[v].size++] = neighbour;
}

void ReducibleGraph::move_to_end(std::int32_t v, std::int64_t capacity) {
  List& list = lists_[v];
  if (list.begin < marked_end_) moved_.emplace_back(v, list);
  const auto begin = static_cast<std::int64_t>(pool_.size());
  pool_.resize(pool_.size() + static_cast<std::size_t>(capacity));
  std::copy_n(pool_.begin() + list.begin, list.size, pool_.begin() + begin);
  list.begin = begin;
  list.capacity = capacity;
}

void ReducibleGraph::mark() {
  if (pool_.size() > 2 * packed_size_ + 1024) pack();
  pool_.push_back(0);  // so that an empty list at the end, too, begins before the mark
  marked_end_ = static_cast<std::int64_t>(pool_.size());
  marked_vertices_ = vertex_count();
  marked_alive_ = alive_count_;
  removed_.clear();
  moved_.clear();
}

void ReducibleGraph::rollback() {
  for (const std::int32_t v : removed_) alive_[v] = 1;
  for (const auto& [v, list] : moved_) {
    lists_[v] = list;
    stale_[v] = 1;
  }
  alive_count_ = marked_alive_;
  pool_.resize(static_cast<std::size_t>(marked_end_));
  weights_.resize(marked_vertices_);
  lists_.resize(marked_vertices_);
  alive_.resize(marked_vertices_);
  stale_.resize(marked_vertices_);
  removed_.clear();
  moved_.clear();
}

void ReducibleGraph::pack() {
  std::vector<std::int32_t> packed;
  marked_end_ = 0;
  for (std::int32_t v = 0; v < vertex_count(); ++v) {
    const auto begin = static_cast<std::int64_t>(packed.size());
    if (alive(v)) {
      const auto neighbours = neighbours_of(v);
      packed.insert(packed.end(), neighbours.begin(), neighbours.end());
    }
    const std::int64_t size = static_cast<std::int64_t>(packed.size()) - begin;
    lists_[v] = {begin, size, size};
  }
  pool_ = std::move(packed);
  packed_size_ = pool_.size();
}

graph::ConflictGraph ReducibleGraph::compress(std::vector<std::int32_t>& vertices) {
  std::vector<std::int32_t> numbers(weights_.size(), 0);
  vertices.clear();
  for (std::int32_t v = 0; v < vertex_count(); ++v) {
    if (!alive(v)) continue;
    numbers[v] = static_cast<std::int32_t>(vertices.size());
    vertices.push_back(v);
  }
  graph::ConflictGraph graph;
  for (const std::int32_t v : vertices) {
    for (const std::int32_t u : neighbours_of(v)) graph.neighbours.push_back(numbers[u]);
    graph.offsets.push_back(static_cast<std::int64_t>(graph.neighbours.size()));
    graph.weights.push_back(weights_[v]);
  }
  return graph;
}

}  // namespace hexpipe::mwis::reduce
