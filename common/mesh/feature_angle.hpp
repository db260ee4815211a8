#pragma once
// Where a surface has an edge that is kept.

#include <cmath>
#include <numbers>

namespace hexpipe {

// An edge of the surface is a feature where the normals of its triangles differ by more, in degrees.
inline constexpr double default_feature_angle = 40;

inline double cosine_of_degrees(double angle) {
  return std::cos(angle * std::numbers::pi / 180);
}

}  // namespace hexpipe
