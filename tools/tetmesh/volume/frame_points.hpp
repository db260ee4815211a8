#pragma once
// Points inside a surface along a frame field, on a lattice that bends with it and passes through the surface's points.
//
// T.-C. Baudouin, J.-F. Remacle, E. Marchandise, F. Henrotte, C. Geuzaine: A frontal approach to hex-dominant mesh
// generation (2014) step from the surface along a frame field and keep a point when none is near in the frame's maximum
// norm. Here the steps are those of a lattice that was fitted to the frames and to the surface's points as a whole
// (lattice_field.hpp), so that fronts from opposite walls meet where that is possible; points that many nodes see come
// first.

#include <array>
#include <cstdint>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/feature_angle.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/volume/dislocations.hpp"

namespace hexpipe::tetmesh::volume {

struct FramePointsOptions {
  sizing::SizeField size = 1;
  double clearance = 0.5;  // least distance from the surface before points are jittered, in sizes
  // Each coordinate moves by at most that, in sizes. Candidates a vertex, and the share of the volume in hexes, over
  // three parts: 11.3 and 87.2 % at 0, 8.4 and 87.6 at 0.01, 7.4 and 87.7 at 0.02, 6.2 and 87.6 at 0.04.
  double jitter = 0.04;
  std::uint64_t seed = 1;
  double feature_angle = default_feature_angle;
  std::array<Vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // of a lattice, to see how far the frames are from it
};

struct FramePoints {
  std::vector<Vec3> points;   // in the order in which they were accepted
  double turned_share = 0;    // of the vertices: where the frame is more than 10 degrees out of the lattice's axes
  Dislocations dislocations;  // of their lattice
};

// `background`: a mesh of the surface with points inside at about the same distance; its first vertices are the
// surface's.
FramePoints frame_points(const solid::Surface& surface, const TetMesh& background, const TetAdjacency& adjacency,
                         const FramePointsOptions& options);

}  // namespace hexpipe::tetmesh::volume
