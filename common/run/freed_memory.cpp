#include "common/run/freed_memory.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace hexpipe {

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

}  // namespace hexpipe
