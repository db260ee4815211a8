#pragma once
// Sizes that give thin walls some elements across.

#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::sizing {

// From the surface straight inwards to where a ray leaves the material, through a face that is turned by at most 45
// degrees against the ray (L. Shapira, A. Shamir, D. Cohen-Or: Consistent mesh partitioning and skeletonisation using
// the shape diameter function, 2008, with one ray in place of a cone). Where that length is less than `layers` times
// `size`, its part by the layers is the size of the wall, in all of it between the two sides; but at least a 32nd of
// `size`. Sides that meet at an edge, at more than 15 degrees, are no wall. Rays start at most a size apart.
std::vector<SizePrism> wall_sizes(const solid::Surface& surface, double size, int layers);

}  // namespace hexpipe::tetmesh::sizing
