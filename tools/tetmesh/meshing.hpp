#pragma once
// From a surface that bounds a solid to a mesh: makes its triangles anew, places points inside, calls TetGen, and
// places the points again along the frame field of the first mesh.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/points/point_files.hpp"
#include "tools/tetmesh/point_kind.hpp"
#include "tools/tetmesh/sizing/size_demand.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/statistics.hpp"
#include "tools/tetmesh/tetgen/build_mesh.hpp"
#include "tools/tetmesh/volume/dislocations.hpp"

namespace hexpipe::tetmesh {

struct MeshingOptions {
  bool remesh = true;  // false: the surface's triangles stay
  double feature_angle, deviation, short_features, row_stretch;
  PointKind points;
  const formats::PointList& given_points;  // for PointKind::given
  double clearance;                        // in sizes
  std::optional<double> jitter;            // in sizes; nothing: the default of the kind of points
  std::uint64_t seed;
  double most_points;     // inside
  double tetgen_timeout;  // seconds for all runs that make one mesh
  bool estimates;         // sets TetmeshStatistics::hex_share
};

// A mesh and what it was made of.
struct MeshedSurface {
  std::optional<solid::Surface> made_surface;  // nothing: the given one
  sizing::SizeField size;
  tetgen::BuiltMesh built;
  TetmeshStatistics statistics;  // without repair, seconds.checking, and the figures of surface and mesh
  std::vector<std::string> warnings;
  std::optional<volume::LineSegments> dislocations;  // of points along a frame field

  const solid::Surface& surface(const solid::Surface& given) const { return made_surface ? *made_surface : given; }
};

// `size` is field_of() the demand. Throws TetGenFailure.
MeshedSurface mesh_surface(const solid::Surface& given, const sizing::SizeDemand& demand, sizing::SizeField size,
                           const MeshingOptions& options);

// Whether the points along the frame field plainly give more hexes than the lattice's, so that no estimate is needed:
// the surface was made anew, and much of the model is turned out of the lattice's axes. `tets` is the number of tets of
// the mesh with the lattice's points.
bool frame_plainly_wins(bool remeshed, double turned_share, std::size_t tets);

// Otherwise: by the estimated shares of the volume in hexes (0 to 1), of which the lattice's has to be clearly higher.
bool frame_wins(double lattice_share, double frame_share);

}  // namespace hexpipe::tetmesh
