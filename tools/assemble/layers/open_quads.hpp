#pragma once
// Quads of walls become triangles where lines without length would leave no cells over them.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"
#include "tools/assemble/layers/walls.hpp"

namespace hexpipe::assemble::layers {

// Over a quad all four lines have a length, the two of one edge, or none. Where others have, the quad is cut into two
// triangles, and the cells behind it into pyramids and tets around a new vertex (a pyramid into two tets), if these are
// valid. `grows`: by line of `walls`. Returns whether the mesh has changed: then the walls have to be found anew.
bool open_quads(MixedMesh& mesh, std::vector<Vertex>& origin, const Walls& walls, std::span<const std::uint8_t> grows);

}  // namespace hexpipe::assemble::layers
