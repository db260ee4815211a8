#pragma once
// Which items (triangles or cells, for example) are at each vertex, in flat arrays.

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

template <class Item>
class VertexItemsOf {
 public:
  VertexItemsOf() = default;

  // each_corner(visit) calls visit(vertex, item) for every corner of every item, items ascending. It is called twice.
  template <class EachCorner>
  VertexItemsOf(std::size_t vertex_count, EachCorner&& each_corner) : offsets_(vertex_count + 1) {
    each_corner([&](Vertex v, Item) { ++offsets_[v + 1]; });
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    items_.resize(static_cast<std::size_t>(offsets_.back()));
    std::vector<std::int64_t> next(offsets_.begin(), offsets_.end() - 1);
    each_corner([&](Vertex v, Item item) { items_[next[v]++] = item; });
  }

  // The items at a vertex, ascending.
  std::span<const Item> at(Vertex v) const {
    return std::span(items_).subspan(offsets_[v], offsets_[v + 1] - offsets_[v]);
  }

 private:
  std::vector<std::int64_t> offsets_;
  std::vector<Item> items_;
};

using VertexItems = VertexItemsOf<std::int32_t>;

inline VertexItems triangles_at_vertices(std::size_t vertex_count, std::span<const Triangle> triangles) {
  return VertexItems(vertex_count, [&](auto&& visit) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (const Vertex v : triangles[t]) visit(v, static_cast<std::int32_t>(t));
  });
}

}  // namespace hexpipe
