#pragma once
// Finds most pairs of triangles that have no point in common, in doubles, and never a pair that has.
//
// Exact predicates are slowest on pairs in one plane, up to rounding: a microsecond and more.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

class ApartTest {
 public:
  // The arrays must outlive the test.
  ApartTest(std::span<const Vec3> points, std::span<const Triangle> triangles)
      : points_(points), triangles_(triangles) {
    for (const Vec3& p : points) greatest_ = std::max({greatest_, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    directions_.reserve(triangles.size());
    for (const auto& [a, b, c] : triangles) {
      const std::array sides{points[b] - points[a], points[c] - points[b], points[a] - points[c]};
      const Vec3 normal = unit(cross(sides[0], sides[1]));
      const auto by_length = [](const Vec3& s, const Vec3& t) { return norm_squared(s) < norm_squared(t); };
      directions_.push_back({normal, cross(normal, unit(*std::ranges::max_element(sides, by_length)))});
    }
  }

  // Whether two triangles without common corners certainly have no point in common.
  bool are_apart(std::int32_t first, std::int32_t second) const {
    const Triangle &a = triangles_[first], &b = triangles_[second];
    for (const auto& directions : {directions_[first], directions_[second]})
      for (const Vec3& direction : directions)
        if (are_apart_along(a, b, direction)) return true;
    return false;
  }

  // Whether two triangles with a common corner 0 certainly have no other point in common: a plane through that corner
  // separates them. Most triangles of about the same size are separated by the plane halfway between their opposite
  // sides, which needs no roots; the others by the plane halfway between their angles.
  bool are_apart_beyond_corner(const Triangle& a, const Triangle& b) const {
    const Vec3& corner = points_[a[0]];
    const Vec3 a1 = points_[a[1]] - corner, a2 = points_[a[2]] - corner;
    const Vec3 b1 = points_[b[1]] - corner, b2 = points_[b[2]] - corner;
    const auto least_beyond = [&](const Vec3& direction) {
      return std::min({-dot(a1, direction), -dot(a2, direction), dot(b1, direction), dot(b2, direction)});
    };
    const Vec3 between = (b1 + b2) - (a1 + a2);
    const double beyond = least_beyond(between);
    if (beyond > 0 && beyond * beyond > room() * room() * norm_squared(between)) return true;
    return least_beyond(unit(unit(b1) + unit(b2)) - unit(unit(a1) + unit(a2))) > room();
  }

 private:
  // The rounding error of differences of coordinates, and of products of these with directions no longer than 2.
  double room() const { return 64 * std::numeric_limits<double>::epsilon() * greatest_; }

  bool are_apart_along(const Triangle& a, const Triangle& b, const Vec3& direction) const {
    const Vec3& origin = points_[a[0]];
    const auto at = [&](Vertex v) { return dot(points_[v] - origin, direction); };
    const auto [low_a, high_a] = std::minmax({0.0, at(a[1]), at(a[2])});
    const auto [low_b, high_b] = std::minmax({at(b[0]), at(b[1]), at(b[2])});
    return low_b > high_a + room() || low_a > high_b + room();
  }

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  double greatest_ = 0;
  // at right angles to the triangle, and in its plane at right angles to the longest side
  std::vector<std::array<Vec3, 2>> directions_;
};

}  // namespace hexpipe
