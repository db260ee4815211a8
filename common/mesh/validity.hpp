#pragma once
// Exact answers about the sign of Jacobians, for any coordinates: doubles with an error bound first, integers if they
// cannot tell.

#include <array>
#include <cstdint>
#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/lanes.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe {

// The sign of det(b - a, c - a, d - a): 1 if the tet abcd is positively oriented, 0 if it is flat, otherwise -1.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// True if the Jacobian is positive everywhere in the cell with these corners (8, 6, 5 or 4 finite points, in the
// numbering of cell_topology.hpp). The quads of hexes, prisms and pyramids are bilinear.
//
// Hex: docs/definitions.md 1, rule 4: 20 determinants, 27 Bezier coefficients, at most 4 subdivisions. A hex that is
// still undecided then has a Jacobian that touches zero or nearly does; it is not valid. Prism: three quadratics, one
// along each of 03, 14, 25, decided without subdivision. Pyramid: the Jacobian is the bilinear interpolation of its
// value at the four corners of the base, times a square.
bool is_valid(CellKind kind, std::span<const Vec3> corners);

// Judges hexes side by side, one bit each. A set bit means valid: the hex's 20 determinants and 27 coefficients are
// positive for sure, as is the case for most. The others may be valid, too.
std::uint32_t surely_valid_hexes(const std::array<LaneVector, 8>& corners);

}  // namespace hexpipe
