#pragma once
// Some tets of a mesh as a mesh of its own, where everything keeps its order.

#include <cstdint>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

struct Submesh {
  TetMesh mesh;
  // For each point, tet and triangle here: its number in the mesh. Ascending.
  std::vector<Vertex> points;
  std::vector<TetIndex> tets;
  std::vector<std::int32_t> triangles;
};

// The submesh with these points, tets and triangles. All three lists ascend, and `points` has all the points that the
// others use. `scratch` may hold anything; callers that take many submeshes pass the same one to save memory.
Submesh submesh(const TetMesh& mesh, std::vector<Vertex> points, std::vector<TetIndex> tets,
                std::vector<std::int32_t> triangles, std::vector<std::int32_t>& scratch);

// The tets that have a point at most `edges` edges away from a marked one, and the triangles between their points.
Submesh submesh_around(const TetMesh& mesh, const std::vector<bool>& marked, int edges);

}  // namespace hexpipe
