#pragma once
// Which sides of the surface face each other across the inside of the model.

#include <vector>

#include "tools/tetmesh/surface/field_surface.hpp"

namespace hexpipe::tetmesh::surface {

struct OppositeSide {
  // the first triangle that a ray from the centre meets, inwards along the normal; -1: none
  std::int32_t triangle = -1;
  double distance = 0;  // in sizes
  double area = 0;      // the area around that this triangle is a sample of, in squares of the size
};

// The side opposite each triangle. There is none where the other side is not nearly parallel or is further than 25
// sizes. Among several small triangles one stands for all; the others have none.
std::vector<OppositeSide> opposite_sides(const FieldSurface& surface);

}  // namespace hexpipe::tetmesh::surface
