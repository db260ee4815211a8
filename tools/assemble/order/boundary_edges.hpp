#pragma once
// The edges of a mesh's facets: which of them lie on sharp edges and borders of tags, and how the surface bends along
// them, as far as the facets alone tell.

#include <array>
#include <cstdint>
#include <vector>

#include "common/mesh/mixed_mesh.hpp"

namespace hexpipe::assemble::order {

struct BoundaryEdge {
  Vertex a, b;    // a < b
  bool is_sharp;  // a sharp edge, a border of tags, or where not just two facets meet
  Vec3 normal;    // of the facets, unit; that of one of them if the edge is sharp
  Vec3 bent;      // where the middle of a smooth curve or surface through the vertices is
};

// In the order of their ends.
std::vector<BoundaryEdge> boundary_edges(const MixedMesh& mesh);

}  // namespace hexpipe::assemble::order
