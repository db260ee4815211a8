#pragma once
// Vertices and tets that lie near each other in space get numbers near each other, so that later stages find them near
// each other in memory.

#include <cstddef>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::tetgen {

// Numbers the vertices along a Morton curve through the box around them, and the tets by their lowest vertices. The
// `added` points of TetGen, which are the last, stay the last. The mesh stays the same: coordinates, the order of the
// corners of each tet, and the order of the triangles do not change.
void number_along_curve(TetMesh& mesh, std::size_t added);

}  // namespace hexpipe::tetmesh::tetgen
