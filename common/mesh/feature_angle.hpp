#pragma once
// Which edges of a surface are kept.

#include <cmath>
#include <numbers>

namespace hexpipe {

// An edge of the surface is a feature if the normals of its two triangles differ by more than this angle, in degrees.
inline constexpr double default_feature_angle = 40;

inline double cosine_of_degrees(double angle) {
  return std::cos(angle * std::numbers::pi / 180);
}

}  // namespace hexpipe
