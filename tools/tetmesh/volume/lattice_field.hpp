#pragma once
// Where the points of a lattice lie that follows a frame field: at every node its own place in the cell of the lattice
// that is around it. The lattice passes through the points of the surface and bends between them.
//
// This is the periodic parametrization of N. Ray, W. C. Li, B. Lévy, A. Sheffer, P. Alliez (2006), in space as in
// D. Sokolov, N. Ray, L. Untereiner, B. Lévy: Hexahedral-Dominant Meshing (2016): a complex number of modulus 1 an
// axis, whose argument is the coordinate in the lattice times 2 pi. Seen from a neighbour it turns by the distance
// along the axis. The linear problem comes first, without the modulus; then each number is set to the mean of its
// neighbours' views of it, over and over. Deviates in that the surface's points are known and attract the lattice.

#include <array>
#include <optional>
#include <vector>

#include "tools/tetmesh/volume/lattice_links.hpp"

namespace hexpipe::tetmesh::volume {

struct LatticeField {
  LatticeLinks links;  // of the nodes, with the distances that the lattice has
  // Of each node, along each axis of its frame: from -1/2 to 1/2 cells from a point of the lattice.
  std::vector<std::array<double, 3>> coordinates;
  // From one point of the lattice to the next along each axis, in sizes.
  std::vector<std::array<Vec3, 3>> steps;
  // How far the neighbours agree with that, from 0 to 1, on the axis where they do least.
  std::vector<double> agreement;
};

// Of a lattice that passes through the surface, the steps from one of its points to another along an axis of the first
// one's frame, `length` sizes: as many as go across the part where they lie on sides that face each other along the
// axis, else one along the surface, or none. Nothing where rows would have to stretch too much.
std::optional<int> steps_on_surface(const Vec3& axis, const Vec3& normal, const Vec3& other_normal, double length);

// The cells of the lattice are as wide as the sizes of the nodes.
LatticeField solve_lattice_field(const FieldNodes& nodes, const std::vector<fields::Frame>& frames);

}  // namespace hexpipe::tetmesh::volume
