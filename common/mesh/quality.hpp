#pragma once
// How good and how large a cell is. Its corners are given in the numbering of cell_topology.hpp, as many as its kind
// has.

#include <array>
#include <cmath>
#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe {

// det(u, v, w) / (|u| |v| |w|): 1 at a right-handed corner of a box, 0 if a vector vanishes.
inline double scaled_jacobian(const Vec3& u, const Vec3& v, const Vec3& w) {
  const double lengths = norm(u) * norm(v) * norm(w);
  return lengths > 0 ? det(u, v, w) / lengths : 0;
}

// Whether scaled_jacobian(u, v, w) > threshold >= 0, given the determinant and the product of the squared lengths.
// Squares are compared, because on lattices corners of exactly 0.5 are common and the rounding of square roots must not
// decide.
inline bool scaled_jacobian_exceeds(double determinant, double squared_lengths, double threshold) {
  return determinant * std::abs(determinant) > threshold * threshold * squared_lengths;
}
inline bool scaled_jacobian_exceeds(const Vec3& u, const Vec3& v, const Vec3& w, double threshold) {
  return scaled_jacobian_exceeds(det(u, v, w), norm_squared(u) * norm_squared(v) * norm_squared(w), threshold);
}

// The points of a cell's corners; the rest of the array stays at the origin.
inline std::array<Vec3, 8> corner_points(std::span<const Vec3> points, std::span<const Vertex> corners) {
  std::array<Vec3, 8> result;
  for (std::size_t i = 0; i < corners.size(); ++i) result[i] = points[corners[i]];
  return result;
}

// A hex should have this scaled Jacobian at every corner: findhex finds no poorer hexes unless it is told to, assemble
// lets none in and presses none below it, and tetmesh counts hexes above it.
inline constexpr double least_hex_quality = 0.3;
// Cells of other kinds are good enough from here on: nothing that assemble or fitcad does presses them below it.
inline constexpr double good_enough = 0.12;
// A prism, which stands in a column where rows end, and which a solver sees as it sees hexes, should have this:
// smoothing makes room for it and presses none below, nor does what merges vertices. Layers at walls and fitcad may.
inline constexpr double least_prism_quality = 0.3;

// The least scaled Jacobian over the corners; for a pyramid, over the four of its base.
double least_corner_scaled_jacobian(CellKind kind, std::span<const Vec3> corners);

// The least scaled Jacobian over the whole cell. The value is attained, and at most `quality_tolerance` above the true
// minimum. For an invalid cell it is some value <= 0 or close to it. On the triangles of a prism, any two of the three
// sides count as a corner's, so that the value is the same from all corners. It is never above the least over the
// corners.
inline constexpr double quality_tolerance = 1e-3;
double least_scaled_jacobian(CellKind kind, std::span<const Vec3> corners);

// The signed volume, exact up to rounding; quads are bilinear.
double cell_volume(CellKind kind, std::span<const Vec3> corners);
// Its gradient as one corner moves; the volume is linear in the place of each corner.
Vec3 cell_volume_gradient(CellKind kind, std::span<const Vec3> corners, int corner);

}  // namespace hexpipe
