#pragma once
// Where faces of the input meet: points on its sharp edges, and its corners.

#include <array>
#include <optional>
#include <vector>

#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {

// As in extended marching cubes (L. Kobbelt, M. Botsch, U. Schwanecke, H.-P. Seidel: Feature sensitive surface
// extraction from volume data, 2001): three planes meet in a corner; two leave a line, on which the point nearest to a
// given one is taken.
class SharpPointFinder {
 public:
  // Degrees; edges that turn by more are sharp. Keeps a reference to the input.
  SharpPointFinder(const TriangleTree& input, double feature_angle);

  // For a triangle, from the planes of the input at its corners.
  std::optional<Vec3> find(const std::array<Vec3, 3>& corners, const std::array<Plane, 3>& planes) const;

  // All that any two and three of the planes have near `middle`: within 1.5 times `size`.
  std::vector<Vec3> find_all(const Vec3& middle, double size, const std::vector<Plane>& planes) const;

  bool is_sharp(const Plane& one, const Plane& other) const { return dot(one.normal, other.normal) <= sharp_cosine_; }

 private:
  std::optional<Vec3> meet(const Vec3& middle, double size, std::array<Plane, 3> meeting, bool corner) const;

  const TriangleTree& input_;
  double sharp_cosine_;
};

}  // namespace hexpipe::wrap
