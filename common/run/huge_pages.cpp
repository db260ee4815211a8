#include "common/run/huge_pages.hpp"

#include <sys/mman.h>

#include <cstdint>

namespace hexpipe {

void use_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t page = 4096, huge_page = 512 * page;
  const auto begin = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (begin + page - 1) / page * page, last = (begin + bytes) / page * page;
  // What it answers does not matter: pages are small then.
  if (first + huge_page <= last) ::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

}  // namespace hexpipe
