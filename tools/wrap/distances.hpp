#pragma once
// How far two surfaces are from each other, both ways.

#include "tools/wrap/surface.hpp"
#include "tools/wrap/triangle_tree.hpp"

namespace hexpipe::wrap {

struct DistanceSummary {
  double greatest = 0, mean = 0;  // the mean is over the area
  double share_beyond = 0;        // of the area that is farther away than the limit
};

// From points of `surface` that are at most `spacing` apart to the triangles of `other`.
DistanceSummary distances(const Surface& surface, const TriangleTree& other, double spacing, double limit);

}  // namespace hexpipe::wrap
