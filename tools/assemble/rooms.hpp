#pragma once
// Rooms between the hexes that are filled anew with fewer cells.

#include <cstdint>

#include "tools/assemble/gap_mesh.hpp"

namespace hexpipe {

struct RoomCounts {
  std::int64_t vertices = 0;  // that went with the cells around them
  std::int64_t fixedv=0, pairs=0, prisms=0, rings=0, grown=0, around=0;
  std::int64_t edges = 0;     // whose cells became fewer
};

// Fills the cells around a free vertex, and those around an edge, anew (refill.hpp) while the objective falls.
RoomCounts refill_rooms(GapMesh& gap);

}  // namespace hexpipe
