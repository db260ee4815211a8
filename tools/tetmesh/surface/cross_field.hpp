#pragma once
// A 4-fold cross field on a surface: four directions at right angles in every triangle. They run along the feature
// curves and, where the surface bends, along its principal curvatures; elsewhere they are as smooth as that allows.

#include <array>
#include <span>
#include <vector>

#include "tools/tetmesh/surface/field_surface.hpp"
#include "tools/tetmesh/surface/opposite_sides.hpp"

namespace hexpipe::tetmesh::surface {

// A direction that is nearer than that to another, by about 20 degrees, runs along it.
inline constexpr double aligned_cosine = 0.94;

struct CrossField {
  // One of the four directions of each triangle, of length 1 and in the triangle's plane.
  std::vector<Vec3> directions;

  // That direction and the one to its left.
  std::array<Vec3, 2> axes(const FieldSurface& surface, std::int32_t triangle) const {
    return {directions[triangle], cross(surface.normals[triangle], directions[triangle])};
  }
};

// A full bend over the size counts as much as smoothness. If `opposite` is not empty, sides that face each other across
// the inside get the same directions as far as their features let them.
CrossField cross_field(const FieldSurface& surface, std::span<const OppositeSide> opposite = {});

// A field for which opposite sides are taken into account, and these sides. Both are found at the same time as far as
// they do not need each other.
struct FieldAndSides {
  CrossField field;
  std::vector<OppositeSide> opposite;
};
FieldAndSides cross_field_across(const FieldSurface& surface);

}  // namespace hexpipe::tetmesh::surface
