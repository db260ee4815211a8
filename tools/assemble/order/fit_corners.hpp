#pragma once
// Moves vertices of the boundary onto the surface that the mesh was made of: the triangles of the mesh's own surface,
// on which they slid before, are chords of it.

#include <cstdint>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/order/given_surface.hpp"

namespace hexpipe::assemble::order {

struct FitCounts {
  std::int64_t moved = 0;
  std::int64_t held = 0;  // too far away, or a cell would lose more than a tenth of its quality
  double farthest = 0;    // of those that moved
};

// The mesh has no nodes of second order yet. Vertices where sharp edges meet, end or turn stay. Cells stay valid. Does
// not update the blocks' quality.
FitCounts fit_corners(MixedMesh& mesh, const GivenSurface& surface);

}  // namespace hexpipe::assemble::order
