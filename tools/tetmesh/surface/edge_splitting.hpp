#pragma once
// Cuts triangles until none is much larger than the size, for surfaces whose triangles cannot be made anew.

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::surface {

// Cuts the longest edge in its middle, with all of its triangles, until no edge is longer than one and a half sizes.
// The surface and its points stay where they are. Triangles of a sheet stay together.
solid::Surface split_long_edges(const solid::Surface& surface, const sizing::SizeField& size);

}  // namespace hexpipe::tetmesh::surface
