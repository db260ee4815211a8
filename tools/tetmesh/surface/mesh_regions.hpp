#pragma once
// Regions of a surface mesh that can be changed at the same time.
//
// Changes of two regions do not meet if everything that a change reads or writes belongs to faces with a corner in its
// region, and everything that it writes to faces with all corners there.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/tetmesh/surface/delaunay_flips.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"

namespace hexpipe::tetmesh::surface {

class MeshRegions {
 public:
  // Halves the vertices repeatedly, each time across the longest extent, until a region has at most about `most`
  // vertices (which must not be 0) or there are 64 regions. A mesh with at least a quarter of `most` vertices has at
  // least two regions.
  MeshRegions(const FeatureMesh& mesh, std::size_t most);

  std::size_t size() const { return size_; }
  std::size_t of(OpenMesh::VertexHandle v) const { return of_[v.idx()]; }
  // Whether a vertex of the region can be collapsed into a neighbour: its neighbours and their neighbours lie in the
  // region, too.
  bool has_around(std::size_t region, const FeatureMesh& mesh, OpenMesh::VertexHandle v) const;
  // Whether the edge can be flipped in the region.
  bool has(std::size_t region, const EdgeDiamond& diamond) const;

 private:
  std::size_t size_ = 1;
  std::vector<std::uint8_t> of_;  // by vertex
};

}  // namespace hexpipe::tetmesh::surface
