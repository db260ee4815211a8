#pragma once
// Which quads lie on the boundary of the input: these need no cell on their other side.

#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::hybrid {

class BoundaryQuads {
 public:
  // `tags`: those of `mesh`, with every facet of its boundary; they have to outlive this.
  BoundaryQuads(const TetMesh& mesh, const TetAdjacency& adjacency, const SurfaceTags& tags);

  // Tagged triangles inside, which have a tet on either side, do not count.
  bool contains(const Quad& quad) const;

 private:
  const SurfaceTags& tags_;
  std::vector<bool> is_outer_;  // by tagged triangle
};

}  // namespace hexpipe::assemble::hybrid
