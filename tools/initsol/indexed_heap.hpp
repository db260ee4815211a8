#pragma once
// A priority queue of vertices whose keys change. The highest key comes first, and among equal keys the lowest vertex,
// so that the order does not depend on earlier changes.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::initsol {

class IndexedHeap {
 public:
  explicit IndexedHeap(std::size_t vertices) : places_(vertices, no_index) {}

  bool empty() const { return heap_.empty(); }
  bool contains(std::int32_t v) const { return places_[v] != no_index; }
  std::int32_t top() const { return heap_.front().vertex; }
  std::int64_t top_key() const { return heap_.front().key; }

  void insert(std::int32_t v, std::int64_t key) {
    heap_.push_back({key, v});
    places_[v] = static_cast<std::int32_t>(heap_.size()) - 1;
    rise(heap_.size() - 1);
  }

  void update(std::int32_t v, std::int64_t key) {
    const auto at = static_cast<std::size_t>(places_[v]);
    heap_[at].key = key;
    rise(at);
    sink(static_cast<std::size_t>(places_[v]));
  }

  void erase(std::int32_t v) {
    const auto at = static_cast<std::size_t>(places_[v]);
    swap_entries(at, heap_.size() - 1);
    heap_.pop_back();
    places_[v] = no_index;
    if (at == heap_.size()) return;
    const std::int32_t moved = heap_[at].vertex;
    rise(at);
    sink(static_cast<std::size_t>(places_[moved]));
  }

  void clear() {
    for (const Entry& entry : heap_) places_[entry.vertex] = no_index;
    heap_.clear();
  }

  // Children do not come before their parents, and every vertex is where places say. For tests.
  bool check() const {
    for (std::size_t i = 0; i < heap_.size(); ++i) {
      if (places_[heap_[i].vertex] != static_cast<std::int32_t>(i)) return false;
      if (i > 0 && before(heap_[i], heap_[(i - 1) / 2])) return false;
    }
    return true;
  }

 private:
  struct Entry {
    std::int64_t key;
    std::int32_t vertex;
  };

  static bool before(const Entry& a, const Entry& b) { return a.key != b.key ? a.key > b.key : a.vertex < b.vertex; }

  void swap_entries(std::size_t a, std::size_t b) {
    std::swap(heap_[a], heap_[b]);
    places_[heap_[a].vertex] = static_cast<std::int32_t>(a);
    places_[heap_[b].vertex] = static_cast<std::int32_t>(b);
  }
  void rise(std::size_t at) {
    for (; at > 0 && before(heap_[at], heap_[(at - 1) / 2]); at = (at - 1) / 2) swap_entries(at, (at - 1) / 2);
  }
  void sink(std::size_t at) {
    for (;;) {
      std::size_t first = at;
      for (const std::size_t child : {2 * at + 1, 2 * at + 2})
        if (child < heap_.size() && before(heap_[child], heap_[first])) first = child;
      if (first == at) return;
      swap_entries(at, first);
      at = first;
    }
  }

  std::vector<Entry> heap_;
  std::vector<std::int32_t> places_;
};

}  // namespace hexpipe::initsol
