#pragma once
// How much of a tet mesh merges into hexes, quickly: enough to tell which of two meshes of a part is the better one.
//
// A small relative of findhex with a greedy choice: from each vertex along three edges that are nearly at right angles,
// with the common neighbours that come nearest to a parallelepiped. Hexes far from that are not looked for.

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::volume {

// The part of the volume, from 0 to 1.
double estimate_hex_share(const TetMesh& mesh, const TetAdjacency& adjacency);

}  // namespace hexpipe::tetmesh::volume
