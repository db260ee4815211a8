#pragma once
// Triangles whose corners lie in one line but for rounding. Nothing can be told from their normals: edges beside them
// seem sharp, and bends of the surface seem to be where there are none. OpenCASCADE makes them around the tip of a
// cone.

#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

// Flips the longest edge of such a triangle, so that its third corner cuts the triangle beyond in two; the surface
// moves by at most a millionth of the diagonal. Edges stay that are curves, or where tags, shells or regions meet.
// Returns how many were flipped.
std::size_t flip_flat_triangles(Surface& surface);

}  // namespace hexpipe::tetmesh::solid
