#pragma once
// Exact answers about the sign of Jacobians, whatever the coordinates: doubles with an error bound first, integers
// where they cannot tell.

#include <array>
#include <cstdint>
#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/lanes.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe {

// The sign of det(b - a, c - a, d - a): 1 where the tet abcd is positively oriented, 0 where it is flat, else -1.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// True when the Jacobian is positive everywhere in the cell with these corners (8, 6, 5 or 4 of them, finite), in the
// numbering of cell_topology.hpp. Sides of hexes, prisms and pyramids are bilinear.
//
// Hex: docs/definitions.md 1, rule 4: 20 determinants, 27 Bezier coefficients, at most 4 subdivisions; a hex that is
// still undecided then, its Jacobian touching zero or nearly so, is not valid. Prism: three quadratics, one along each
// of 03, 14, 25, decided without subdivision. Pyramid: the Jacobian is the bilinear interpolation of its value at the
// four base corners, times a square.
bool is_valid(CellKind kind, std::span<const Vec3> corners);

// Hexes side by side, a bit for each: those whose 20 determinants and 27 coefficients are positive for sure, as most
// are, are valid; the others may be.
std::uint32_t surely_valid_hexes(const std::array<LaneVector, 8>& corners);

}  // namespace hexpipe
