#pragma once
// Finds out whether the outside got in. Then the wrap is a thin shell on both sides of the input's triangles.

#include <optional>
#include <vector>

#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {

struct Sheets {
  double share = 0;            // of the wrap's area: where the wrap is on the other side of the input, too
  std::vector<char> is_sheet;  // by triangle of the input: most of the wrap near it is in that share
};

// `offset` is the wrap's distance from the input, which has `count` triangles.
Sheets find_sheets(const Surface& wrapped, const TriangleTree& input, std::size_t count, double offset);

struct Hole {
  Vec3 middle;
  double width;  // of a round or square hole with its area and perimeter
  std::size_t edges;
};

// The widest ring of edges that only one triangle has, where points at the same place are one.
std::optional<Hole> widest_hole(const Surface& surface);

}  // namespace hexpipe::wrap
