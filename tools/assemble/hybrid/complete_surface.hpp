#pragma once
// The input's surface as assemble needs it.

#include <string>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::assemble::hybrid {

// Leaves among the mesh's triangles all boundary and interface facets, and no others than facets of tets.
void complete_surface(TetMesh& mesh, const TetAdjacency& adjacency);

}  // namespace hexpipe::assemble::hybrid
