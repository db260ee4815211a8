#pragma once
// Estimates before the work is done: how many points a lattice will have inside a surface, and how much of a tet mesh
// merges into hexes.

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::volume {

// The number of points, at the distances of the field, that lie in material and at least `clearance` sizes away from
// the surface: the volume there in cubes of the size. The estimate is between a third and three times the number. It
// stops when it comes to more than `enough`.
double points_inside(const solid::Surface& surface, const sizing::SizeField& size, double clearance, double enough);

// Throws DataError if the size makes more than `most` points inside.
void check_point_count(const solid::Surface& surface, double size, double most);

// Throws DataError if the sizes differ by place and make far more than `most` points inside. For smaller excesses see
// graded_lattice_points().
void check_point_count(const solid::Surface& surface, const sizing::SizeField& size, double clearance, double most);

// The share of the volume in hexes, from 0 to 1, precisely enough to tell which of two meshes of a model is better.
//
// It is a small relative of findhex with a greedy choice. It looks from each vertex along three edges that are nearly
// at right angles, and takes the common neighbours that come nearest to a parallelepiped. It does not look for hexes
// that are far from that.
double estimate_hex_share(const TetMesh& mesh, const TetAdjacency& adjacency);

}  // namespace hexpipe::tetmesh::volume
