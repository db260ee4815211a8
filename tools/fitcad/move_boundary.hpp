#pragma once
// Moves vertices of the boundary to their targets. No cell becomes invalid, and none poorer than it is allowed to.

#include <cstdint>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/fitcad/targets.hpp"

namespace hexpipe::fitcad {

struct MoveCounts {
  std::int64_t moved = 0;   // vertices of the boundary that are in another place now
  std::int64_t inside = 0;  // vertices inside that made room
  std::int64_t slid = 0;    // vertices of the boundary that made room, along the face or the curve on which they are
  std::int64_t held = 0;    // vertices of the boundary that could not go all the way
};

// A cell that is better than good enough (hexes least_hex_quality, others good_enough) stays so, and a poorer one loses at
// most a tenth of its quality. Where that holds vertices back, cells other than hexes may lose half of it, down to
// 0.02. Targets of vertices that slid become those of their new places.
MoveCounts move_boundary(MixedMesh& mesh, const CadShape& shape, Targets& targets);

}  // namespace hexpipe::fitcad
