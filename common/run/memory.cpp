#include "common/run/memory.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "common/run/error.hpp"

namespace hexpipe {
namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

// The number that follows `name` in a file of lines "name number"; 0 if it is not there.
std::uint64_t number_behind(std::string_view name, const std::string& file) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(name) && line.size() > name.size() && line[name.size()] == ' ')
      return std::strtoull(line.c_str() + name.size(), nullptr, 10);
  return 0;
}

// The number that follows `name` in a file of lines "name: number kB", in bytes; 0 if it is not there.
std::uint64_t bytes_in(const char* file, std::string_view name) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(name) && line.size() > name.size() && line[name.size()] == ':')
      return 1024 * std::strtoull(line.c_str() + name.size() + 1, nullptr, 10);
  return 0;
}

// The number in a file that holds only that; `unlimited` if it holds "max".
std::uint64_t number_in(const std::string& file) {
  std::ifstream stream(file);
  std::uint64_t number = 0;
  return stream >> number ? number : unlimited;
}

std::uint64_t difference(std::uint64_t limit, std::uint64_t used) {
  return limit == unlimited ? unlimited : limit - std::min(limit, used);
}

std::uint64_t left_on_machine() {
  const std::uint64_t available = bytes_in("/proc/meminfo", "MemAvailable");
  return available == 0 ? unlimited : available + bytes_in("/proc/meminfo", "SwapFree");
}

std::uint64_t left_under_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_DATA, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  return difference(limit.rlim_cur, bytes_in("/proc/self/status", "VmData"));
}

std::string readable(double bytes) {
  constexpr double mebibyte = 1 << 20;
  const double size = bytes / mebibyte;
  return size < 1024 ? fmt::format("{:.0f} MiB", size) : fmt::format("{:.1f} GiB", size / 1024);
}

}  // namespace

void limit_memory(std::uint64_t bytes) {
  rlimit limit{};
  getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = std::min<rlim_t>(bytes, limit.rlim_max);
  if (setrlimit(RLIMIT_DATA, &limit) != 0)
    throw DataError(fmt::format("cannot limit memory: {}", std::strerror(errno)));
}

std::uint64_t left_in_control_group(const std::string& folder) {
  const std::uint64_t current = number_in(folder + "/memory.current");
  const std::string statistics = folder + "/memory.stat";
  const std::uint64_t of_files = number_behind("active_file", statistics) + number_behind("inactive_file", statistics);
  return difference(number_in(folder + "/memory.max"), current - std::min(current, of_files));
}

std::uint64_t memory_left() {
  return std::min({left_under_limit(), left_in_control_group("/sys/fs/cgroup"), left_on_machine()});
}

void expect_memory(std::uint64_t count, std::uint64_t bytes_each, std::string_view where) {
  const std::uint64_t left = memory_left();
  if (count <= left / bytes_each) return;
  throw DataError::at(where, "expected {} of memory, found {} left",
                      readable(static_cast<double>(count) * static_cast<double>(bytes_each)),
                      readable(static_cast<double>(left)));
}

void reuse_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // no more is allowed
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
}

void FreedMemory::add(std::size_t bytes) {
  // malloc_trim walks over the allocator's lists; that is well worth this much memory.
  constexpr std::size_t enough = 2 << 20;
  freed_ += bytes;
  if (freed_ < enough) return;
  freed_ = 0;
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void use_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::size_t page = 4096, huge_page = 512 * page;
  const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(memory) % page) % page;
  if (before + huge_page > bytes) return;
  // The result does not matter: without large pages, the small ones stay.
  ::madvise(static_cast<char*>(memory) + before, (bytes - before) / page * page, MADV_HUGEPAGE);
#endif
}

}  // namespace hexpipe
