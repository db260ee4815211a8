#pragma once
// How much of a tet mesh merges into hexes, quickly: enough to tell which of two meshes of a part is the better one.
//
// A small relative of findhex with a greedy choice: from each vertex along three edges that are nearly at right angles,
// with the common neighbours that come nearest to a parallelepiped. Hexes far from that are not looked for.

#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::volume {

struct HexEstimate {
  std::vector<double> volumes, hexes;  // of each region, by its tag: of all of it, and of hexes in it

  // The part of the volume, from 0 to 1: of a region, and of all.
  double share_of(std::size_t region) const { return volumes[region] > 0 ? hexes[region] / volumes[region] : 0; }
  double share() const;
};

HexEstimate estimate_hexes(const TetMesh& mesh, const TetAdjacency& adjacency);

inline double estimate_hex_share(const TetMesh& mesh, const TetAdjacency& adjacency) {
  return estimate_hexes(mesh, adjacency).share();
}

}  // namespace hexpipe::tetmesh::volume
