#pragma once
// Is the Jacobian of a cell of second order positive everywhere? Its determinant is a polynomial, whose coefficients in
// Bernstein's basis bound it.
//
// A. Johnen, J.-F. Remacle, C. Geuzaine: Geometrical validity of curvilinear finite elements (J. Comput. Phys. 233,
// 2013); A. Johnen, C. Geuzaine: Geometrical validity of high-order pyramidal finite elements (J. Comput. Phys. 299,
// 2015).

#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe::curved {

// The Jacobian determinant of a cell, by which the two functions below compare cells of one kind: up to a positive
// factor that is the same for all of them.
//
// `nodes`: corners, then nodes in the order of node_places_of(): 20 or 27 of a hex, 15 or 18 of a prism, 13 or 14 of a
// pyramid, 10 of a tet. The pyramid is the rational one that fits to quads of eight or nine nodes and triangles of six
// (M. Bergot, G. Cohen, M. Duruflé, 2010).

// The least at the corners; where a pyramid's apex is a corner for each direction out of it.
double least_at_corners(CellKind kind, std::span<const Vec3> nodes);

// Whether it is above `least` everywhere, and above what rounding can be. False if that is not shown.
bool is_above(CellKind kind, std::span<const Vec3> nodes, double least);

// True if it is positive everywhere.
inline bool is_valid(CellKind kind, std::span<const Vec3> nodes) {
  return is_above(kind, nodes, 0);
}

}  // namespace hexpipe::curved
