#pragma once
// The distance of points that suits a model where the user gives none.

#include <algorithm>
#include <cmath>

namespace hexpipe {

// What is known of a model.
struct ModelExtent {
  double diagonal = 0;  // of the bounding box
  double area = 0;      // of the surface
  double volume = 0;
};

// A twentieth of the diagonal, but at most half of the mean wall thickness, which makes two layers, and at least a
// hundredth of the cube root of the volume. `longest`: more than that it is not, either.
inline double default_size(const ModelExtent& model, double longest) {
  constexpr double of_diagonal = 0.05, of_thickness = 0.5, of_cube_root = 0.01;
  const double thickness = 2 * model.volume / model.area;
  const double size = std::min({of_diagonal * model.diagonal, of_thickness * thickness, longest});
  return std::max(size, of_cube_root * std::cbrt(model.volume));
}

}  // namespace hexpipe
