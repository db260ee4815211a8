#pragma once
// From TetGen's tets to the mesh: judges the tets against the surface, gives them their regions, and empties the holes.

#include <span>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/run/error.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/tetgen/run_tetgen.hpp"

namespace hexpipe::tetmesh::tetgen {

struct BuiltMesh {
  TetMesh mesh;  // points: of the surface, then inside, then added by TetGen; triangles: of the surface
  TetAdjacency adjacency;
  std::size_t added_points = 0;    // by TetGen, off the surface
  std::size_t dropped_points = 0;  // of the interior points
};

// TetGen failed, or its result is not what it was asked for.
class TetGenFailure : public DataError {
 public:
  using DataError::DataError;
};

// Throws TetGenFailure if TetGen failed, moved a point or lost a triangle of the surface, or left a tet without volume,
// or if the tets of a region do not add up to the region's volume.
BuiltMesh build_mesh(const solid::Surface& surface, std::span<const Vec3> interior_points, TetGenResult tetgen);

// The volume of a mesh, and how flat its tets get.
struct MeshShape {
  double volume = 0;
  double least_dihedral = 180, greatest_dihedral = 0;  // degrees, over all tets
};

MeshShape shape_of(const TetMesh& mesh);

}  // namespace hexpipe::tetmesh::tetgen
