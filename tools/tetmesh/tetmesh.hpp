#pragma once
// From a surface to tetrahedra: checks it, finds its shells, places points inside, calls TetGen, judges what it made.

#include <optional>
#include <string>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "formats/surfaces/surface_soup.hpp"
#include "tools/tetmesh/options.hpp"
#include "tools/tetmesh/statistics.hpp"
#include "tools/tetmesh/volume/dislocations.hpp"

namespace hexpipe::tetmesh {

struct TetmeshResult {
  TetMesh mesh;
  formats::GroupNames names;
  TetmeshStatistics statistics;
  std::vector<std::string> warnings;
  std::optional<volume::LineSegments> dislocations;  // of points along a frame field
};

// Throws DataError where the surface is not the boundary of a solid and where TetGen fails; UsageError where options
// contradict each other.
TetmeshResult tetmesh(formats::SurfaceSoup soup, const TetmeshOptions& options);

}  // namespace hexpipe::tetmesh
