#pragma once
// Points inside a surface along a frame field, on a lattice that bends with the field and passes through the surface's
// points.
//
// T.-C. Baudouin, J.-F. Remacle, E. Marchandise, F. Henrotte, C. Geuzaine: A frontal approach to hex-dominant mesh
// generation (2014) step from the surface along a frame field, and keep a point if none is near in the frame's maximum
// norm. Here the steps are those of a lattice that was fitted to the frames and to the surface's points as a whole
// (lattice_field.hpp), so that fronts from opposite walls meet where that is possible. Points that many nodes see come
// first.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/defaults.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/surface/surface_lattice.hpp"
#include "tools/tetmesh/volume/dislocations.hpp"

namespace hexpipe::tetmesh::volume {

struct FramePointsOptions {
  sizing::SizeField size = 1;
  double clearance = 0.5;  // least distance from the surface before points are jittered, in sizes
  // Each coordinate moves by at most this, in sizes. Candidates a vertex, and the share of the volume in hexes, over
  // three models: 11.3 and 87.2 % at 0, 8.4 and 87.6 % at 0.01, 7.4 and 87.7 % at 0.02, 6.2 and 87.6 % at 0.04.
  double jitter = 0.04;
  std::uint64_t seed = 1;
  double feature_angle = default_feature_angle;
  std::array<Vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // of a lattice, to compare the frames with
};

struct FramePoints {
  std::vector<Vec3> points;  // in the order in which they were accepted
  double turned_share = 0;   // share of the vertices whose frame is more than 10 degrees out of the lattice's axes
};

// A lattice along the frame field of a background mesh.
class FrameLattice {
 public:
  // `background` is a mesh of the surface with points inside at about the same distance. Its first vertices are those
  // of the surface. All must outlive the lattice.
  FrameLattice(const solid::Surface& surface, const TetMesh& background, const TetAdjacency& adjacency,
               const FramePointsOptions& options);
  ~FrameLattice();

  // Fits the lattice to the frames and to those points of the surface that are `held`: solve_lattice_field(). It can be
  // fitted again. The others need a lattice that was fitted.
  void fit(const std::vector<bool>& held);
  const Dislocations& dislocations() const;
  // Where the lattice has its points on the surface. It must not outlive the lattice, or its next fit.
  surface::RowGuide guide() const;
  // Its points inside a surface: the given one, or another of the same shape whose points follow the guide.
  FramePoints points_inside(const solid::Surface& surface) const;

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace hexpipe::tetmesh::volume
