#pragma once
// Triangles cut until none is much larger than the size: for surfaces whose triangles cannot be made anew.

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::surface {

// Cuts the longest edge in its middle, with all of its triangles, as long as one is longer than one and a half sizes.
// The surface stays where it is, and so do its points. Triangles of a sheet stay together.
solid::Surface split_long_edges(const solid::Surface& surface, const sizing::SizeField& size);

}  // namespace hexpipe::tetmesh::surface
