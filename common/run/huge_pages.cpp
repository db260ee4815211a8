#include "common/run/huge_pages.hpp"

#include <sys/mman.h>

#include <cstdint>

namespace hexpipe {

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
