#pragma once
// Estimates quickly how much of a tet mesh merges into hexes: precisely enough to tell which of two meshes of a model
// is better.
//
// It is a small relative of findhex with a greedy choice. It looks from each vertex along three edges that are nearly
// at right angles, and takes the common neighbours that come nearest to a parallelepiped. It does not look for hexes
// that are far from that.

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::volume {

// The share of the volume, from 0 to 1.
double estimate_hex_share(const TetMesh& mesh, const TetAdjacency& adjacency);

}  // namespace hexpipe::tetmesh::volume
