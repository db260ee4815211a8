#pragma once
// Moves vertices of the boundary to their targets. No cell becomes invalid or poorer than it may be.

#include <cstdint>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/fitcad/targets.hpp"

namespace hexpipe::fitcad {

struct MoveCounts {
  std::int64_t moved = 0;   // vertices of the boundary that are in another place now
  std::int64_t inside = 0;  // vertices inside that made room
  std::int64_t slid = 0;    // vertices of the boundary that made room, along the face or the curve on which they are
  std::int64_t held = 0;    // vertices of the boundary that could not go all the way
  std::int64_t poorer = 0;  // cells that lost more than a tenth of their quality and are below 0.02 now
};

// Qualities are scaled Jacobians. A hex above least_hex_quality and another cell above good_enough stay above it; a
// poorer cell loses at most a tenth of its quality. Where this holds vertices back, cells other than hexes may lose
// half of their quality, down to 0.02. Where this is not enough, vertices go to faces instead of curves that they may
// leave, and then these cells may lose half of their quality up to four times more. Changes points of the mesh, and the
// targets of vertices that slide or leave a curve.
MoveCounts move_boundary(MixedMesh& mesh, const CadShape& shape, Targets& targets);

}  // namespace hexpipe::fitcad
