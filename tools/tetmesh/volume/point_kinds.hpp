#pragma once
// The kinds of points inside a surface, and the user's own.

#include <optional>
#include <string>
#include <vector>

#include "formats/points/point_files.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::volume {

enum class PointKind {
  best,     // makes the meshes of lattice and frame, and keeps the one that is estimated to merge into more hexes
  mixed,    // a result of best: some bodies have the frame's points, the others the lattice's
  frame,    // along a frame field: frame_points.hpp
  lattice,  // along the model's axes: lattice.hpp
  given,    // by the user
  none
};

// Whether tetmesh itself chooses the places of the points.
constexpr bool places_points(PointKind kind) {
  return kind != PointKind::none && kind != PointKind::given;
}

constexpr const char* name_of(PointKind kind) {
  constexpr const char* names[] = {"best", "mixed", "frame", "lattice", "given", "none"};
  return names[static_cast<int>(kind)];
}

struct GivenPoints {
  std::vector<Vec3> points;              // the usable ones, in their order
  std::optional<std::string> complaint;  // about the others, with the place of the first
};

// Leaves out points that are not in material, nearer to the surface than `clearance` (a length), or repeated.
GivenPoints usable_points(const solid::Surface& surface, const formats::PointList& list, double clearance);

}  // namespace hexpipe::tetmesh::volume
