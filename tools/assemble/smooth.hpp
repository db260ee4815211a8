#pragma once
// Moves vertices so that the worst cells become better first, the average after.

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe {

struct SmoothCounts {
  int rounds = 0;  // done; fewer than asked for when nothing moved any more
  std::int64_t moves = 0;
};

// At most `rounds` times over all vertices. No vertex leaves its plane or line (freedom.hpp), no move makes the worst
// cell around it worse, every cell stays valid everywhere.
SmoothCounts smooth(MixedMesh& mesh, int rounds);

}  // namespace hexpipe
