#pragma once
// Points inside a surface on lattices within each other, each with half the steps of the one around it, where sizes
// differ by place.

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/volume/lattice.hpp"

namespace hexpipe::tetmesh::volume {

// The same as lattice_points() where the size is the same everywhere. Otherwise `options.size` is the greatest size,
// and fits the steps of the outermost lattice to the bounding box. A place has the points of the lattice whose steps
// are 0.62 to 1.23 times its size, or 0.44 to 1.74 times along an axis where the model is thinner than the greatest
// size. Throws DataError if more than `most_points` points are inside.
std::vector<Vec3> graded_lattice_points(const solid::Surface& surface, const sizing::SizeField& size,
                                        LatticeOptions options, double most_points);

}  // namespace hexpipe::tetmesh::volume
