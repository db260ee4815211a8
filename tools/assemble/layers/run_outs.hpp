#pragma once
// Layers run out beyond the rim of a wall where the boundary beside it does not lead into the part: where it goes on
// smoothly, or turns away. A line at such a rim cannot stay on both; without run-outs it has no length, and the facets
// of the wall beside it lack layers. With them it goes inwards as a line within the wall does, and the layers' cells
// become wedges over the first facets beyond the rim, whose other vertices have lines without length.

#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/layers/walls.hpp"

namespace hexpipe::assemble::layers {

// The walls, and the facets over which their layers run out.
Walls walls_with_run_outs(const MixedMesh& mesh, std::span<const WallGroup> groups);

}  // namespace hexpipe::assemble::layers
