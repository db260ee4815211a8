#pragma once
// Ways across the bends of a surface count as longer than they are, so that rows of points lie closer there.

#include <vector>

#include "tools/tetmesh/surface/cross_field.hpp"

namespace hexpipe::tetmesh::surface {

struct BendStretch {
  std::vector<double> factor;  // of each triangle, for the way across the bend; 1 elsewhere
  std::vector<Vec3> along;     // the direction along the bend, whose lengths do not change

  explicit BendStretch(std::size_t triangles) : factor(triangles, 1.0), along(triangles) {}

  // The factor for a direction of length 1 in the triangle's plane.
  double in_direction(std::int32_t triangle, const Vec3& direction) const {
    const double cosine = dot(direction, along[triangle]);
    return 1 + (factor[triangle] - 1) * (1 - cosine * cosine);
  }
};

// Small fillets count as the edges that they round off (crest_lines.hpp). Across other bends, where the surface has
// `chord_heights`, rows lie so close that a straight line from one to the next leaves the surface by at most that, up
// to a limit. That holds as far as the bend goes on evenly along the field, because rows would end where it does not,
// and not where the surface bends both ways.
BendStretch bend_stretch(const FieldSurface& surface, const CrossField& field);

}  // namespace hexpipe::tetmesh::surface
