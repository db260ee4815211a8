#pragma once
// Returns memory that was freed in small pieces to the system. The allocator would keep it for later.

#include <cstddef>

namespace hexpipe {

class FreedMemory {
 public:
  // Reports bytes that were freed or are about to be; now and then, the free memory goes back to the system.
  void add(std::size_t bytes);

 private:
  std::size_t freed_ = 0;
};

}  // namespace hexpipe
