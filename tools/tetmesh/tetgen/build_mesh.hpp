#pragma once
// From TetGen's tets to the mesh: judges them against the surface, gives them their regions, empties the holes.

#include <span>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/run/error.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/tetgen/run_tetgen.hpp"

namespace hexpipe::tetmesh::tetgen {

struct BuiltMesh {
  TetMesh mesh;  // points: the surface's, those inside, those that TetGen added; triangles: the surface's
  TetAdjacency adjacency;
  std::size_t added_points = 0;    // by TetGen, off the surface
  std::size_t dropped_points = 0;  // of the interior points
};

// TetGen failed, or did not do what was asked of it.
class TetGenFailure : public DataError {
 public:
  using DataError::DataError;
};

// Throws TetGenFailure when TetGen failed, moved a point or lost a triangle of the surface, left a tet without volume,
// or when the tets' volumes do not add up to that of a region.
BuiltMesh build_mesh(const solid::Surface& surface, std::span<const Vec3> interior_points, TetGenResult tetgen);

}  // namespace hexpipe::tetmesh::tetgen
