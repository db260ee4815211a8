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
};

// Qualities are scaled Jacobians. A hex above least_hex_quality and another cell above good_enough stay above it; a
// poorer cell loses at most a tenth of its quality. Where this holds vertices back, cells other than hexes may lose
// half of their quality, down to 0.02. Changes points of the mesh, and the targets of vertices that slide.
MoveCounts move_boundary(MixedMesh& mesh, const CadShape& shape, Targets& targets);

}  // namespace hexpipe::fitcad
