#include "tools/assemble/shape/nearest_points.hpp"

#include <algorithm>

namespace hexpipe::assemble::shape {

// C. Ericson, "Real-Time Collision Detection" (2005), section 5.1.5: if the foot of the perpendicular falls outside, an
// edge or a corner is nearest.
Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& to) {
  const Vec3 along = b - a;
  const double length = norm_squared(along);
  return length > 0 ? a + along * std::clamp(dot(to - a, along) / length, 0.0, 1.0) : a;
}

Vec3 nearest_on_triangle(const std::array<Vec3, 3>& triangle, const Vec3& to) {
  const auto& [a, b, c] = triangle;
  const Vec3 normal = cross(b - a, c - a);
  const double length = norm_squared(normal);
  auto is_inside = [&](const Vec3& p, const Vec3& q) { return dot(cross(q - p, to - p), normal) >= 0; };
  if (length > 0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a))
    return to - normal * (dot(to - a, normal) / length);
  Vec3 best = nearest_on_segment(a, b, to);
  for (const Vec3& other : {nearest_on_segment(b, c, to), nearest_on_segment(c, a, to)})
    if (norm_squared(other - to) < norm_squared(best - to)) best = other;
  return best;
}

// The plane at right angles to the triangle through an edge has the triangle on one side. The rounding of these
// products is well below the margin.
bool is_surely_farther(const std::array<Vec3, 3>& triangle, const Vec3& to, double squared) {
  constexpr double margin = 1e-12;
  const auto& [a, b, c] = triangle;
  const Vec3 normal = cross(b - a, c - a);
  const double length = norm_squared(normal);
  const auto is_far_beyond = [&](const Vec3& p, const Vec3& q) {
    const double beyond = dot(cross(q - p, to - p), normal);
    return beyond < 0 && beyond * beyond > (squared + margin * norm_squared(to - p)) * (length * norm_squared(q - p));
  };
  return is_far_beyond(a, b) || is_far_beyond(b, c) || is_far_beyond(c, a);
}

}  // namespace hexpipe::assemble::shape
