#pragma once
// A suitable distance of points for a model, if the user gives none.

#include <algorithm>
#include <cmath>

namespace hexpipe {

// The measures of a model that the size depends on.
struct ModelExtent {
  double diagonal = 0;  // of the bounding box
  double area = 0;      // of the surface
  double volume = 0;
};

// A twentieth of the diagonal; at most half of the mean wall thickness, which gives two layers, and at most `longest`;
// but at least a hundredth of the cube root of the volume.
inline double default_size(const ModelExtent& model, double longest) {
  constexpr double of_diagonal = 0.05, of_thickness = 0.5, of_cube_root = 0.01;
  const double thickness = 2 * model.volume / model.area;
  const double size = std::min({of_diagonal * model.diagonal, of_thickness * thickness, longest});
  return std::max(size, of_cube_root * std::cbrt(model.volume));
}

}  // namespace hexpipe
