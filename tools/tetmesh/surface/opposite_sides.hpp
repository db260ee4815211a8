#pragma once
// What faces what across the inside of a part.

#include <vector>

#include "tools/tetmesh/surface/field_surface.hpp"

namespace hexpipe::tetmesh::surface {

struct OppositeSide {
  std::int32_t from = -1;      // a triangle
  std::int32_t triangle = -1;  // the first one that a ray from its centre, inwards along the normal, meets
  double distance = 0;         // in sizes
  double area = 0;             // of the surface around, in squares of the size, of which this is a sample
};

// Of the triangles in their order, of those between two regions on both sides; none where the other side is not nearly
// parallel, or further than 25 sizes, and of most of those that are small: for these, one of several stands.
std::vector<OppositeSide> opposite_sides(const FieldSurface& surface);

}  // namespace hexpipe::tetmesh::surface
