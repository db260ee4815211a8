#pragma once
// Points inside a surface on a slightly jittered lattice along the coordinate axes, kept clear of the surface.
//
// Lattice points next to each other make hexes when their tets are merged; an exact lattice is cospherical, which
// multiplies the candidates by 3 to 5, and a jitter of 2 % of the size prevents it. A lattice point
// too near the surface would make slivers with its triangles.

#include <cstdint>
#include <vector>

#include "tools/tetmesh/shells.hpp"

namespace hexpipe {

struct LatticeOptions {
  double size = 1;         // distance between lattice points; a whole number of steps is fitted to the bounding box
  double clearance = 0.6;  // least distance of lattice points from the surface before they are jittered, in sizes
  double jitter = 0.02;    // each coordinate moves by at most that, in sizes; below half of the clearance
  std::uint64_t seed = 1;
};

// In the order of the lattice, x fastest; a point's jitter depends on the seed and its place in the lattice only.
// Throws DataError when the bounding box holds too many lattice points.
std::vector<Vec3> lattice_points(const Surface& surface, const LatticeOptions& options);

}  // namespace hexpipe
