#pragma once
// Ways straight across a surface from one feature to the next, where these are near.

#include <optional>
#include <vector>

#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// From the middle of a half-edge of a feature. Lengths are in sizes.
struct NarrowStrip {
  std::vector<fields::LoopStep> across;  // from the first triangle to the last
  double before, after;  // from the one feature to the centre of the first, from that of the last to the other
  double width;
};

// Nothing where no feature that is at right angles to the way, as the first is, is met within `widest`.
std::optional<NarrowStrip> narrow_strip(const SurfaceLinks& links, geometry::HalfEdge from, double widest);

}  // namespace hexpipe::tetmesh::surface
