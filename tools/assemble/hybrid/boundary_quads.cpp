#include "tools/assemble/hybrid/boundary_quads.hpp"

#include <cstdint>

#include "common/mesh/cell_topology.hpp"

namespace hexpipe::assemble::hybrid {

BoundaryQuads::BoundaryQuads(const TetMesh& mesh, const TetAdjacency& adjacency, const SurfaceTags& tags)
    : tags_(tags), is_outer_(tags.size()) {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.tets.size()); ++t)
    for (int facet = 0; facet < 4; ++facet) {
      if (adjacency.tet_beyond(t, facet) != TetAdjacency::none) continue;
      const auto& f = TetTopology::triangles[facet];
      const auto triangle = tags.find({mesh.tets[t][f[0]], mesh.tets[t][f[1]], mesh.tets[t][f[2]]});
      if (triangle) is_outer_[*triangle] = true;
    }
}

bool BoundaryQuads::contains(const Quad& quad) const {
  const auto cover = tags_.cover_of(quad);
  return cover && is_outer_[cover->triangles[0]];
}

}  // namespace hexpipe::assemble::hybrid
