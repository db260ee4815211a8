#pragma once
// Which rooms are filled anew (refill.hpp).

#include <cstdint>

#include "tools/assemble/gap/gap_mesh.hpp"

namespace hexpipe::assemble::gap {

struct RefillCounts {
  std::int64_t vertices = 0;  // that went: the cells around them were filled anew
  std::int64_t edges = 0;     // the cells around them were
  std::int64_t poor = 0;      // cells below least_quality that became better with those around them
};

// The cells around a free vertex, those around an edge, and those around a poor cell, while the objective falls. `gap`
// has to be valid, and stays so.
RefillCounts refill_rooms(GapMesh& gap);

}  // namespace hexpipe::assemble::gap
