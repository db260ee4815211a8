#pragma once
// Distances of points, and lengths of rays, to one triangle.

#include <algorithm>
#include <array>

#include "common/mesh/vec3.hpp"

namespace hexpipe::tetmesh::geometry {

class TriangleDistance {
 public:
  TriangleDistance(const Vec3& a, const Vec3& b, const Vec3& c)
      : corners_{a, b, c}, normal_(cross(b - a, c - a)), normal_squared_(norm_squared(normal_)) {}

  const Vec3& normal() const { return normal_; }

  double squared(const Vec3& p) const {
    bool above = true;  // the projection of p lies in the triangle
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& from = corners_[i];
      above = above && det(corners_[(i + 1) % 3] - from, p - from, normal_) >= 0;
    }
    if (above) {
      const double height = dot(p - corners_[0], normal_);
      return height * height / normal_squared_;
    }
    return std::min({squared_to_edge(p, 0), squared_to_edge(p, 1), squared_to_edge(p, 2)});
  }

 private:
  double squared_to_edge(const Vec3& p, std::size_t edge) const {
    const Vec3& from = corners_[edge];
    const Vec3 along = corners_[(edge + 1) % 3] - from, to_point = p - from;
    const double t = std::clamp(dot(to_point, along) / norm_squared(along), 0.0, 1.0);
    return norm_squared(to_point - t * along);
  }

  std::array<Vec3, 3> corners_;
  Vec3 normal_;
  double normal_squared_;
};

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
