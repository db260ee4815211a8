#pragma once
// The tets of a mesh by their lowest vertex. A search goes from vertex to vertex: what it asks about the tets around
// one then lies near what it asked before, in whatever order the mesh had them.

#include <cstdint>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

// The numbers of the mesh's tets by lowest vertex, and ascending at each; none when that is how they stand.
std::vector<std::int32_t> order_by_lowest_vertex(const TetMesh& mesh);

// Puts the item of tet order[i] in place i; leaves items as they are when there is no order.
template <class T>
void reorder(std::vector<T>& items, const std::vector<std::int32_t>& order) {
  if (order.empty()) return;
  std::vector<T> reordered;
  reordered.reserve(items.size());
  for (const std::int32_t tet : order) reordered.push_back(items[tet]);
  items = std::move(reordered);
}

}  // namespace hexpipe
