#pragma once
// From the mesh under assembly to the result: cells in stable order, tagged facets, vertices without gaps.

#include "common/mesh/mixed_mesh.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::hybrid {

struct Extract {
  MixedMesh mesh;
  // The vertex of the mesh under assembly that each point was; below the input's number of points also of the input.
  std::vector<Vertex> origin;
};

// Cells come in the order of their candidates, then tets and pyramids in the order in which they were made; each tagged
// triangle of `tags` is there as it is, or as a quad with another one, in their order and orientation;
// vertices keep their order, those that no cell uses are dropped.
Extract extract(const HybridMesh& mesh, const SurfaceTags& tags);

// Without the cells of a region and the facets with a tag, and the vertices that then no cell uses.
Extract without(const Extract& from, std::int32_t region, std::int32_t tag);
// Without the facets with a tag.
Extract without_facets(Extract from, std::int32_t tag);

}  // namespace hexpipe::assemble::hybrid
