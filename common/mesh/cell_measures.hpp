#pragma once
// The formulas of a cell's quality and volume, for one cell (Vec3) or for several side by side (LaneVector). Both give
// the same bits. quality.hpp says what they measure.

#include <array>
#include <limits>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/lanes.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe {

// The worst corner is found by comparing squares that keep the determinant's sign, so that roots are taken at one
// corner only.
template <class Topology, class Points>
auto least_corner_scaled_jacobian_of(const Points& p) {
  using Number = decltype(norm_squared(p[0]));
  Number least_square = Number{} + std::numeric_limits<double>::infinity();
  Number determinant{}, u_square{}, v_square{}, w_square{};  // at the least corner
  for (const LocalCorner& c : Topology::corners) {
    const auto u = p[c[1]] - p[c[0]], v = p[c[2]] - p[c[0]], w = p[c[3]] - p[c[0]];
    const Number uu = norm_squared(u), vv = norm_squared(v), ww = norm_squared(w);
    const Number d = det(u, v, w), squares = uu * vv * ww;
    const Number square = select(squares > 0, d * absolute(d) / squares, Number{});
    const auto is_less = square < least_square;
    least_square = select(is_less, square, least_square);
    determinant = select(is_less, d, determinant);
    u_square = select(is_less, uu, u_square);
    v_square = select(is_less, vv, v_square);
    w_square = select(is_less, ww, w_square);
  }
  const Number lengths = square_root(u_square) * square_root(v_square) * square_root(w_square);
  return select(lengths > 0, determinant / lengths, Number{});
}

// The sum of the tets from corner 0 to the facets. A bilinear quad encloses the mean of its two triangulations, abc +
// acd and abd + bcd. Their four determinants add up to det(a, b, c + d) + det(c, d, a + b).
template <class Topology, class Points>
auto cell_volume_of(const Points& p) {
  using Number = decltype(norm_squared(p[0]));
  const auto at = [&](int c) { return p[c] - p[0]; };
  Number triangles{}, quads{};
  for (const LocalTriangle& t : Topology::triangles) triangles += det(at(t[0]), at(t[1]), at(t[2]));
  for (const LocalQuad& q : Topology::quads) {
    const auto a = at(q[0]), b = at(q[1]), c = at(q[2]), d = at(q[3]);
    quads += det(a, b, c + d) + det(c, d, a + b);
  }
  return triangles / 6 + quads / 12;
}

// Compares as the function for one corner in quality.hpp does.
inline LaneMask scaled_jacobian_exceeds(const Lanes& determinant, const Lanes& squared_lengths, double threshold) {
  return determinant * absolute(determinant) > threshold * threshold * squared_lengths;
}

struct alignas(lane_bytes) CellMeasures {
  Lanes quality;  // least_corner_scaled_jacobian_of
  Lanes volume;
};

// Measures cells side by side: hexes, prisms or pyramids.
void measure_cells(const std::array<LaneVector, 8>& corners, CellMeasures& measures);
void measure_cells(const std::array<LaneVector, 6>& corners, CellMeasures& measures);
void measure_cells(const std::array<LaneVector, 5>& corners, CellMeasures& measures);

}  // namespace hexpipe
