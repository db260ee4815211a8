#pragma once
// Sizes that give thin walls several elements across.

#include <vector>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::sizing {

// Rays go from the surface straight inwards. A ray measures a wall where it leaves the material through a face that is
// turned by at most 45 degrees against it (L. Shapira, A. Shamir, D. Cohen-Or: Consistent mesh partitioning and
// skeletonisation using the shape diameter function, 2008, with one ray in place of a cone). If the ray is shorter than
// `layers` times `size`, the size of the wall is the ray's length over `layers`, but at least a 32nd of `size`; it
// holds everywhere between the two sides. Sides that meet at an edge of more than 15 degrees are no wall. Rays start at
// most one size apart.
std::vector<SizePrism> wall_sizes(const solid::Surface& surface, double size, int layers);

}  // namespace hexpipe::tetmesh::sizing
