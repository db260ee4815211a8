#pragma once
// Puts large arrays into large pages. The first touch of a page costs as much as many numbers, and a page of 2 MiB
// costs little more than a few of 4 KiB. Smaller arrays, and systems without large pages, lose nothing.

#include <cstddef>
#include <iterator>
#include <vector>

namespace hexpipe {

// Asks the system for large pages. Call it before the memory is touched.
void use_huge_pages(void* memory, std::size_t bytes);

template <class T>
void reserve_in_huge_pages(std::vector<T>& items, std::size_t count) {
  if (count <= items.capacity()) return;
  std::vector<T> larger;
  larger.reserve(count);
  use_huge_pages(larger.data(), count * sizeof(T));
  larger.insert(larger.end(), std::make_move_iterator(items.begin()), std::make_move_iterator(items.end()));
  items.swap(larger);
}

template <class T>
void resize_in_huge_pages(std::vector<T>& items, std::size_t count, const T& added = {}) {
  reserve_in_huge_pages(items, count);
  items.resize(count, added);
}

}  // namespace hexpipe
