#pragma once
// Moves vertices so that the worst cells become better first, the average after.

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe {

struct SmoothCounts {
  int rounds = 0;  // done; fewer than asked for when nothing moved any more
  std::int64_t moves = 0;
};

// What counts as poor: the least scaled Jacobian (of a tet times the square root of 2) that cells should have.
inline constexpr double poor_quality = 0.02;

// Makes cells that are poor or inverted better, at most `rounds` times over their vertices, at the cost of those around
// them; cells that are valid stay so.
void untangle(MixedMesh& mesh, int rounds);

// At most `rounds` times over all vertices. No vertex leaves its plane or line (freedom.hpp), no move makes the worst
// cell around it worse, every cell stays valid everywhere.
SmoothCounts smooth(MixedMesh& mesh, int rounds);

}  // namespace hexpipe
