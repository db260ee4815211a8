#pragma once
// Lists of items and of their numbers.

#include <algorithm>
#include <vector>

namespace hexpipe {

// Sorts, and leaves one of each.
template <class Item>
void sort_unique(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

// The items that are chosen by their numbers, in that order. An index of any kind is a number (index.hpp).
template <class Item, class Number>
std::vector<Item> select_items(const std::vector<Item>& items, const std::vector<Number>& chosen) {
  std::vector<Item> selected;
  selected.reserve(chosen.size());
  for (const Number i : chosen) selected.push_back(items[i]);
  return selected;
}

}  // namespace hexpipe
