#pragma once
// How much memory a tool may take. Work whose size is known beforehand is refused when it is too large.

#include <cstdint>
#include <string>
#include <string_view>

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

}  // namespace hexpipe
