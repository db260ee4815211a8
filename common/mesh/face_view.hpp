#pragma once
// How a program that judges cells by averages of their vertices sees a cell.

#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe {

// The least cosine between the normal of a face (outward, its vector area) and the direction from the cell's centre to
// one of the face's corners. The minimum is over all faces, all their corners, and two centres: the mean of the
// corners, and the centre of mass of the pyramids from that mean to the faces. Some programs use one of these numbers
// to decide whether a cell is inverted, and turn it round when the number is negative: OpenFOAM's gmshToFoam takes the
// second centre and the first corner of each face. A cell whose Jacobian is positive everywhere can still be negative
// here if a side is warped; a valid tet never is. The result is -1 if a face has no area.
double least_face_view(CellKind kind, std::span<const Vec3> corners);

// Whether some readers would turn the cell round. True of prisms only: pyramids over warped bases often look so, but no
// reader is known that turns them, and hexes this warped are poor.
inline bool looks_inverted(CellKind kind, std::span<const Vec3> corners) {
  return kind == CellKind::prism && least_face_view(kind, corners) <= 0;
}
inline bool looks_inverted(CellKind kind, std::span<const Vec3> points, std::span<const Vertex> corners) {
  return kind == CellKind::prism &&
         looks_inverted(kind, std::span<const Vec3>(corner_points(points, corners)).first(corners.size()));
}

}  // namespace hexpipe
