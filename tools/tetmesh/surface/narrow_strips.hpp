#pragma once
// Ways straight across a surface from one feature to the next, where these are near.

#include <optional>
#include <vector>

#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// A way from the middle of a half-edge of a feature. Lengths are in sizes.
struct NarrowStrip {
  std::vector<fields::LoopStep> across;  // from the first triangle to the last
  // from the first feature to the centre of the first triangle, and from the centre of the last triangle to the other
  // feature
  double before, after;
  double width;
};

// Nothing if the way meets no feature within `widest`, or one that is not at right angles to it like the first.
std::optional<NarrowStrip> narrow_strip(const SurfaceLinks& links, geometry::HalfEdge from, double widest);

}  // namespace hexpipe::tetmesh::surface
