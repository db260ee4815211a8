#pragma once
// How good a cell is, and how large. Corners are given in the numbering of cell_topology.hpp, as many as the kind has.

#include <array>
#include <cmath>
#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe {

// det(u, v, w) / (|u| |v| |w|): 1 for a right-handed box corner, 0 where a vector vanishes.
inline double scaled_jacobian(const Vec3& u, const Vec3& v, const Vec3& w) {
  const double lengths = norm(u) * norm(v) * norm(w);
  return lengths > 0 ? det(u, v, w) / lengths : 0;
}

// Whether scaled_jacobian(u, v, w) > threshold >= 0, from the determinant and the product of the squared lengths;
// compared by squares: on lattices, where corners of exactly 0.5 are common, no rounding of square roots decides.
inline bool scaled_jacobian_exceeds(double determinant, double squared_lengths, double threshold) {
  return determinant * std::abs(determinant) > threshold * threshold * squared_lengths;
}
inline bool scaled_jacobian_exceeds(const Vec3& u, const Vec3& v, const Vec3& w, double threshold) {
  return scaled_jacobian_exceeds(det(u, v, w), norm_squared(u) * norm_squared(v) * norm_squared(w), threshold);
}

// The points of a cell's corners, the rest of the array left at the origin.
inline std::array<Vec3, 8> corner_points(std::span<const Vec3> points, std::span<const Vertex> corners) {
  std::array<Vec3, 8> result;
  for (std::size_t i = 0; i < corners.size(); ++i) result[i] = points[corners[i]];
  return result;
}

// What a hex should have at every corner: findhex takes no poorer one unless it is told to, assemble lets no other in
// and presses none below it, and tetmesh counts hexes above it.
inline constexpr double least_hex_quality = 0.3;

// The least scaled Jacobian over the corners; of a pyramid, over the four of its base.
double least_corner_scaled_jacobian(CellKind kind, std::span<const Vec3> corners);

// The least scaled Jacobian over the whole cell: attained, and at most `quality_tolerance` above the true minimum. Of a
// cell that is not valid, some value <= 0, or close to it. On the triangles of a prism each two of the three sides
// count as a corner's, so that the value is the same from all corners. Never above the least over the corners.
inline constexpr double quality_tolerance = 1e-3;
double least_scaled_jacobian(CellKind kind, std::span<const Vec3> corners);

// The signed volume, exact but for rounding; quads are bilinear.
double cell_volume(CellKind kind, std::span<const Vec3> corners);
// How it grows as one corner moves: it is linear in the place of each.
Vec3 cell_volume_gradient(CellKind kind, std::span<const Vec3> corners, int corner);

}  // namespace hexpipe
