#pragma once
// Estimates how many points a lattice will have inside a surface, before any is placed.

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

}  // namespace hexpipe::tetmesh::volume
