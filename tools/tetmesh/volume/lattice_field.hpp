#pragma once
// A lattice that follows a frame field, given by its coordinates at every node: where the node lies in the lattice cell
// around it. The lattice passes through the points of the surface and bends between them.
//
// This is the periodic parametrization of N. Ray, W. C. Li, B. Lévy, A. Sheffer, P. Alliez (2006), in space as in
// D. Sokolov, N. Ray, L. Untereiner, B. Lévy: Hexahedral-Dominant Meshing (2016). Each node has a complex number of
// modulus 1 for each axis; its argument is the coordinate in the lattice times 2 pi. Seen from a neighbour, it turns by
// the distance along the axis. The linear problem, without the modulus, is solved first; then sweeps set each number to
// the mean of its neighbours' views of it. Unlike the papers, the surface's points are known here and hold the lattice.

#include <array>
#include <optional>
#include <vector>

#include "tools/tetmesh/volume/lattice_links.hpp"

namespace hexpipe::tetmesh::volume {

struct LatticeField {
  LatticeLinks links;  // between nodes, with their distances in the lattice
  // For each node and each axis of its frame, the distance from a point of the lattice in cells, from -1/2 to 1/2.
  std::vector<std::array<double, 3>> coordinates;
  // For each node, the step from one point of the lattice to the next along each axis, in sizes.
  std::vector<std::array<Vec3, 3>> steps;
  // For each node, how well its neighbours agree with its coordinates, from 0 to 1, on the worst of the three axes.
  std::vector<double> agreement;
};

// The number of steps of the lattice between two linked points of the surface that are `length` sizes apart along
// `axis`, an axis of the first one's frame. Both points are points of the lattice, so it is a whole number: across the
// model, where they lie on sides that face each other along the axis, as many as there are layers; otherwise one or
// none. No number where rows would have to stretch too much.
std::optional<int> steps_on_surface(const Vec3& axis, const Vec3& normal, const Vec3& other_normal, double length);

// Solves for a lattice whose cells are as wide as the sizes of the nodes. `held` says which points of the surface are
// points of the lattice; all of them if it is empty. Through the others only a layer of the lattice passes.
LatticeField solve_lattice_field(const FieldNodes& nodes, const std::vector<fields::Frame>& frames,
                                 const std::vector<bool>& held = {});

}  // namespace hexpipe::tetmesh::volume
