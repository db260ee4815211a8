#pragma once
// The kinds of points inside.

namespace hexpipe::tetmesh::volume {

enum class PointKind {
  best,     // makes the meshes of lattice and frame, and keeps the one that is estimated to merge into more hexes
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
  constexpr const char* names[] = {"best", "frame", "lattice", "given", "none"};
  return names[static_cast<int>(kind)];
}

}  // namespace hexpipe::tetmesh::volume
