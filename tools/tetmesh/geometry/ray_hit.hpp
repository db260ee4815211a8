#pragma once
// Where a ray meets a triangle.

#include <limits>

#include "common/mesh/vec3.hpp"

namespace hexpipe::tetmesh::geometry {

// How far along the direction the ray's line meets the triangle, in lengths of the direction; negative behind the
// start. Infinite where the line misses the triangle (T. Möller, B. Trumbore: Fast, minimum storage ray/triangle
// intersection, 1997).
inline double length_to_triangle(const Vec3& from, const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double miss = std::numeric_limits<double>::infinity();
  const Vec3 first = b - a, second = c - a, across = cross(direction, second), to_origin = from - a;
  const double volume = dot(first, across);
  if (volume == 0) return miss;
  const double u = dot(to_origin, across) / volume;
  const Vec3 other = cross(to_origin, first);
  const double v = dot(direction, other) / volume;
  if (u < 0 || v < 0 || u + v > 1) return miss;
  return dot(second, other) / volume;
}

}  // namespace hexpipe::tetmesh::geometry
