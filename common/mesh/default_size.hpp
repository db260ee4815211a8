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

// A twentieth of the diagonal; at most half of the mean wall thickness, which gives two layers, so fine that 6,000 cubes of
// this size fill the volume, and at most `longest`; but at least a hundredth of the cube root of the volume, a million cubes.
// Models with fewer cells lose by the size alone: over HexMe 6,000 cubes have 96 % of the volume in hexes, 5 % of the
// diagonal 92 (docs/log/pipeline.md).
inline double default_size(const ModelExtent& model, double longest) {
  constexpr double of_diagonal = 0.05, of_thickness = 0.5, fewest_cubes = 6000, most_cubes = 1e6;
  const double thickness = 2 * model.volume / model.area;
  const double size = std::min(
      {of_diagonal * model.diagonal, of_thickness * thickness, std::cbrt(model.volume / fewest_cubes), longest});
  return std::max(size, std::cbrt(model.volume / most_cubes));
}

}  // namespace hexpipe
