#pragma once
// Which sides of the surface face each other across the inside of the model.

#include <vector>

#include "tools/tetmesh/surface/field_surface.hpp"

namespace hexpipe::tetmesh::surface {

struct OppositeSide {
  std::int32_t from = no_index;      // a triangle
  std::int32_t triangle = no_index;  // the first triangle that a ray from its centre meets, along its normal
  double distance = 0;               // in sizes
  double area = 0;                   // the area around that `from` is a sample of, in squares of the size
};

// In the order of the triangles; rays go inwards, and both ways from triangles between two regions. There is none where
// the other side is not nearly parallel or is further than 25 sizes. Among several small triangles one stands for all.
std::vector<OppositeSide> opposite_sides(const FieldSurface& surface);

}  // namespace hexpipe::tetmesh::surface
