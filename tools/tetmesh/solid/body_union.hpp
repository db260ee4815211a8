#pragma once
// Bodies that overlap, joined into one: `--unite`.

#include <cstddef>

#include "formats/surfaces/surface_soup.hpp"

namespace hexpipe::tetmesh::solid {

// Joins closed bodies whose surfaces intersect (CGAL's corefinement, which is
// exact until its points are rounded). Each new triangle gets the tag and the
// place of the old triangle that it lies on. Bodies that intersect no other one
// stay as they are, to the last bit. Returns the number of bodies that were
// joined to others. Throws DataError where a body that intersects another one
// is open, intersects itself, or points inward, and where two touch in an edge
// or a vertex alone.
std::size_t unite_bodies(formats::SurfaceSoup& soup);

}  // namespace hexpipe::tetmesh::solid
