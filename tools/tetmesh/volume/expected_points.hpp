#pragma once
// How many points a lattice will have inside a surface, before any is placed.

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::volume {

// About how many points at the distances of the field lie in material and `clearance` sizes away from the surface: the
// volume there in cubes of the size. A third of them at least, three times as many at most; stops where they come to
// more than `enough`.
double points_inside(const solid::Surface& surface, const sizing::SizeField& size, double clearance, double enough);

}  // namespace hexpipe::tetmesh::volume
