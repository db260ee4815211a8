#pragma once
// Points inside a surface on lattices within each other, each of half the steps of the one around it, where sizes
// differ by place.

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/volume/lattice.hpp"

namespace hexpipe::tetmesh::volume {

// As lattice_points(), which it is where the sizes are the same everywhere: `options.size` is the greatest, and fits
// the steps of the outermost lattice to the bounding box. A place has the points of the lattice with steps from 0.62
// to 1.23 times its size, or from 0.44 to 1.74 along an axis where the part is thinner than the greatest size. Throws
// DataError where more than `most_points` are inside.
std::vector<Vec3> graded_lattice_points(const solid::Surface& surface, const sizing::SizeField& size,
                                        LatticeOptions options, double most_points);

}  // namespace hexpipe::tetmesh::volume
