#pragma once
// Defaults that depend on the model: which edges of its surface are sharp, and how far apart points are.

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hexpipe {

// An edge of the surface is a feature if the normals of its two triangles differ by more than this angle, in degrees.
inline constexpr double default_feature_angle = 40;

inline double cosine_of_degrees(double angle) {
  return std::cos(angle * std::numbers::pi / 180);
}

// The measures of a model that the size depends on.
struct ModelExtent {
  double diagonal = 0;  // of the bounding box
  double area = 0;      // of the surface
  double volume = 0;
};

// A suitable distance of points, the least of: a twentieth of the diagonal; half of the mean wall thickness (two
// layers); the edge of a cube of which 6,000 fill the volume; `longest`. But no less than what the machine bears: the
// edge of a cube of which a million fill the volume, and of a square of which a quarter of a million cover one side of
// what is thin (one layer of flat hexes then; a million squares took tetmesh 9 GB). Models with fewer cells lose by the
// size alone: on HexMe hexes have 96.9 % of the volume with the 6,000, and 93.2 without (docs/log/pipeline.md).
inline double default_size(const ModelExtent& model, double longest) {
  constexpr double of_diagonal = 0.05, of_thickness = 0.5, fewest_cubes = 6000, most_cubes = 1e6,
                   most_squares = 250'000;
  const double thickness = 2 * model.volume / model.area;
  const double size = std::min(
      {of_diagonal * model.diagonal, of_thickness * thickness, std::cbrt(model.volume / fewest_cubes), longest});
  return std::max({size, std::cbrt(model.volume / most_cubes), std::sqrt(model.area / 2 / most_squares)});
}

}  // namespace hexpipe
