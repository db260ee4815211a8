#pragma once
// Gives memory that was freed in small pieces back to the system, which the allocator else keeps for later.

#include <cstddef>

namespace hexpipe {

class FreedMemory {
 public:
  // Tells of bytes that were or are about to be freed; now and then, what is free goes back.
  void add(std::size_t bytes);

 private:
  std::size_t freed_ = 0;
};

}  // namespace hexpipe
