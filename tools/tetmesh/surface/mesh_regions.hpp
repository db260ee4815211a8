#pragma once
// Regions of a surface mesh that can be changed at the same time.
//
// Where everything that a change reads or writes belongs to faces with a corner in the region, and everything that it
// writes to faces with all corners there, changes of two regions do not meet.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/tetmesh/surface/delaunay_flips.hpp"
#include "tools/tetmesh/surface/feature_mesh.hpp"

namespace hexpipe::tetmesh::surface {

class MeshRegions {
 public:
  // Halves of halves of the vertices, cut across the longest way, until they have at most about `most` vertices, which
  // must not be 0, or there are 64 of them; at least two where there are a quarter of that.
  MeshRegions(const FeatureMesh& mesh, std::size_t most);

  std::size_t size() const { return size_; }
  std::size_t of(OpenMesh::VertexHandle v) const { return of_[v.idx()]; }
  // Whether a vertex of the region can be collapsed into a neighbour: its neighbours and theirs lie there, too.
  bool has_around(std::size_t region, const FeatureMesh& mesh, OpenMesh::VertexHandle v) const;
  // Whether an edge can be flipped.
  bool has(std::size_t region, const EdgeDiamond& diamond) const;

 private:
  std::size_t size_ = 1;
  std::vector<std::uint8_t> of_;  // of vertices
};

}  // namespace hexpipe::tetmesh::surface
