#pragma once
// Some tets of a mesh as a mesh of its own, in which all keeps its order.

#include <cstdint>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

struct Submesh {
  TetMesh mesh;
  // Of each point, tet and triangle, which it is in the mesh, ascending.
  std::vector<std::int32_t> points, tets, triangles;
};

// Of these points, tets and triangles, ascending, of which the points are all that the others use. `scratch` may hold
// anything; who takes many submeshes saves its memory by giving the same one.
Submesh submesh(const TetMesh& mesh, std::vector<std::int32_t> points, std::vector<std::int32_t> tets,
                std::vector<std::int32_t> triangles, std::vector<std::int32_t>& scratch);

// The tets with a point that is at most `edges` edges away from a marked one, and the triangles whose points they have.
Submesh submesh_around(const TetMesh& mesh, const std::vector<bool>& marked, int edges);

}  // namespace hexpipe
