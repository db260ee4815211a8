#pragma once
// Estimates quickly how much of a tet mesh merges into hexes: precisely enough to tell which of two meshes of a model
// is better.
//
// It is a small relative of findhex with a greedy choice. It looks from each vertex along three edges that are nearly
// at right angles, and takes the common neighbours that come nearest to a parallelepiped. It does not look for hexes
// that are far from that.

#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::volume {

// By the region's tag.
struct HexEstimate {
  std::vector<double> volumes;  // of the whole region
  std::vector<double> hexes;    // of the hexes in it

  // The share of the volume, from 0 to 1: of a region, and of the whole mesh.
  double share_of(std::size_t region) const { return volumes[region] > 0 ? hexes[region] / volumes[region] : 0; }
  double share() const;
};

HexEstimate estimate_hexes(const TetMesh& mesh, const TetAdjacency& adjacency);

inline double estimate_hex_share(const TetMesh& mesh, const TetAdjacency& adjacency) {
  return estimate_hexes(mesh, adjacency).share();
}

}  // namespace hexpipe::tetmesh::volume
