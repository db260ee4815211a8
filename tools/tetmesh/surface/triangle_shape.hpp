#pragma once
// How near a triangle is to an equilateral one.

#include <algorithm>
#include <array>
#include <cmath>

#include "common/mesh/vec3.hpp"

namespace hexpipe::tetmesh::surface {

// 1 for an equilateral triangle, 0 for one without area. `area_normal` is twice as long as the area.
inline double shape_of(const std::array<Vec3, 3>& c, const Vec3& area_normal) {
  const double sides = norm_squared(c[1] - c[0]) + norm_squared(c[2] - c[1]) + norm_squared(c[0] - c[2]);
  return 2 * std::sqrt(3.0) * norm(area_normal) / std::max(sides, 1e-300);
}

}  // namespace hexpipe::tetmesh::surface
