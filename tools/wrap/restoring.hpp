#pragma once
// Gives a wrap the shape of what it is wrapped around: its points go to the input, and sharp edges come back.

#include <cstddef>

#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {

struct RestoreOptions {
  double reach;          // points go to the input from no farther than this
  double feature_angle;  // degrees; edges that turn by more are sharp. 180: none
};

struct RestoredSurface {
  Surface surface;
  std::size_t points_on_input = 0,
              points_off_input = 0;  // the latter span gaps, or would make the surface cross itself
  std::size_t sharp_points = 0;      // were added on sharp edges and at corners
  std::size_t slivers = 0;           // nearly flat or folded triangles that had to stay
};

// The wrap must not cross itself; neither does the result.
RestoredSurface restore_shape(const Surface& wrapped, const TriangleTree& input, const RestoreOptions& options);

}  // namespace hexpipe::wrap
