#pragma once
// Lists in a new order.

#include <utility>
#include <vector>

namespace hexpipe {

// Moves item order[i] to place i, for all i.
template <class T, class Index>
void reorder(std::vector<T>& items, const std::vector<Index>& order) {
  std::vector<T> reordered;
  reordered.reserve(items.size());
  for (const Index i : order) reordered.push_back(std::move(items[i]));
  items = std::move(reordered);
}

}  // namespace hexpipe
