#pragma once
// The kinds of points inside a surface.

namespace hexpipe::tetmesh {

enum class PointKind {
  best,     // makes the meshes of lattice and frame, and keeps the one that is estimated to merge into more hexes
  mixed,    // a result of best: some bodies have the frame's points, the others the lattice's
  frame,    // along a frame field: volume/frame_points.hpp
  lattice,  // along the model's axes: volume/lattice.hpp
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

}  // namespace hexpipe::tetmesh
