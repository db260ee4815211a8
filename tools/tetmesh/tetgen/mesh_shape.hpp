#pragma once
// The volume of a mesh, and how flat its tets get.

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::tetgen {

struct MeshShape {
  double volume = 0;
  double least_dihedral = 180, greatest_dihedral = 0;  // degrees, over all tets
};

MeshShape shape_of(const TetMesh& mesh);

}  // namespace hexpipe::tetmesh::tetgen
