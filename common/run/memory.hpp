#pragma once
// How much memory a tool may take: what is too large is refused before it is begun, where its size is known by then.

#include <cstdint>
#include <string>
#include <string_view>

namespace hexpipe {

// Makes every allocation beyond so many bytes fail, in this process and those it starts. Throws DataError when the
// system refuses that.
void limit_memory(std::uint64_t bytes);

// Bytes that may still be allocated, under the limit, in the control group and on the machine with its swap space.
std::uint64_t memory_left();

// What a control group of version 2 whose files are in this folder, where a container sees its own at
// /sys/fs/cgroup, has left. Pages of files that the kernel keeps until it needs their place count as left.
std::uint64_t left_in_control_group(const std::string& folder);

// Throws DataError when no memory is left for so many items; `where` begins its message.
void expect_memory(std::uint64_t count, std::uint64_t bytes_each, std::string_view where);

}  // namespace hexpipe
