#pragma once
// The user's own points inside a surface.

#include <optional>
#include <string>
#include <vector>

#include "formats/points/point_files.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::volume {

struct GivenPoints {
  std::vector<Vec3> points;              // the usable ones, in their order
  std::optional<std::string> complaint;  // about the others, with the place of the first
};

// Leaves out points that are not in material, nearer to the surface than `clearance` (a length), or repeated.
GivenPoints usable_points(const solid::Surface& surface, const formats::PointList& list, double clearance);

}  // namespace hexpipe::tetmesh::volume
