#pragma once
// A 4-fold cross field on a surface: four directions at right angles in every triangle, along the feature curves and,
// where the surface bends, along its principal curvatures, as smooth as that allows.

#include <array>
#include <span>
#include <vector>

#include "tools/tetmesh/surface/field_surface.hpp"
#include "tools/tetmesh/surface/opposite_sides.hpp"

namespace hexpipe::tetmesh::surface {

struct CrossField {
  // Of each triangle, one of its four directions: of length 1, in its plane.
  std::vector<Vec3> directions;

  // That, and the one to its left.
  std::array<Vec3, 2> axes(const FieldSurface& surface, std::int32_t triangle) const {
    return {directions[triangle], cross(surface.normals[triangle], directions[triangle])};
  }
};

// A full bend over the size counts as much as smoothness. Where `opposite` is not empty, sides that
// face each other across the inside agree as far as their features let them.
CrossField cross_field(const FieldSurface& surface, std::span<const OppositeSide> opposite = {});

// That with the sides that face each other, and these; found at the same time as far as they do not need each other.
struct FieldAndSides {
  CrossField field;
  std::vector<OppositeSide> opposite;
};
FieldAndSides cross_field_across(const FieldSurface& surface);

}  // namespace hexpipe::tetmesh::surface
