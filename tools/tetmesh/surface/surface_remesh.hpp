#pragma once
// A surface's triangles anew, on points that merge into quads and so into hexes: along its features, and between them
// in the directions of a cross field.

#include <optional>
#include <string>

#include "tools/tetmesh/shells.hpp"
#include "tools/tetmesh/size_field.hpp"

namespace hexpipe {

struct RemeshOptions {
  SizeField size = 1;                  // distance of the points
  double feature_angle = 40;           // degrees
  double deviation = 0.15;             // of either surface from the other, at the most, in units
  std::optional<SizeField> unit = {};  // nothing: the size
};

struct RemeshResult {
  // Tags and places are those of the input's triangles, shells come in its order.
  SurfaceSoup soup;
  std::string failure;                  // where it failed: why, in a sentence; the soup is empty
  double from_input = 0, to_input = 0;  // greatest distances of points of the one from the other
  std::size_t feature_points = 0, front_points = 0;
  // Of the input, that stay because the deviation, or a surface that does not intersect itself, asks for them.
  std::size_t extra_points = 0;
  int attempts = 0;
};

// Never throws for what the surface is like: where no new surface keeps what is promised, it says so.
RemeshResult remesh_surface(const Surface& surface, const RemeshOptions& options);

}  // namespace hexpipe
