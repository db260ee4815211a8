#pragma once
// How much memory a tool may take, and how it is given back and taken in large pages. Work whose size is known
// beforehand is refused when it is too large.

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace hexpipe {

// Makes every allocation beyond this many bytes fail, in this process and those that it starts. Throws DataError when
// the system refuses.
void limit_memory(std::uint64_t bytes);

// The bytes that may still be allocated, given the limit, the control group and the machine with its swap space.
std::uint64_t memory_left();

// The bytes that a control group of version 2 has left. Its files are in this folder; a container sees its own at
// /sys/fs/cgroup. Cached pages of files count as left, because the kernel drops them when it needs the memory.
std::uint64_t left_in_control_group(const std::string& folder);

// Throws DataError when `count` items do not fit into the memory left; `where` begins the message.
void expect_memory(std::uint64_t count, std::uint64_t bytes_each, std::string_view where);

// Keeps arrays of up to 32 MiB that were freed, 64 MiB in all, for the next ones. The allocator would give those of
// 128 KiB and more back to the system at once, and the next one would pay for its pages again.
void reuse_freed_memory();

// Returns memory that was freed in small pieces to the system. The allocator would keep it for later.
class FreedMemory {
 public:
  // Reports bytes that were freed or are about to be; now and then, the free memory goes back to the system.
  void add(std::size_t bytes);

 private:
  std::size_t freed_ = 0;
};

// Large arrays are put into large pages. The first touch of a page costs as much as many numbers, and a page of 2 MiB
// costs little more than a few of 4 KiB. Smaller arrays, and systems without large pages, lose nothing.

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
