#pragma once
// How a cross field leads on from a feature: along its curve, past one of the curve's vertices, and straight across the
// surface to the next feature, where that is near.

#include <optional>
#include <vector>

#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// The triangles around a vertex of a feature, on one side of it, if one of the field's directions runs along both edges
// of the feature. Lengths are in sizes.
struct FeatureFan {
  geometry::HalfEdge first;  // begins at the vertex and has the first triangle on its left
  geometry::HalfEdge last;   // ends at the vertex and has the last triangle on its left
  // from the centres of these triangles to the middles of the two edges, along the curve
  double first_ahead, last_ahead;
  double apart;                                 // how much further the first centre is from the curve than the last
  std::vector<fields::LoopStep> along, across;  // from the first triangle to the last
};

// The fan at the start of a half-edge of a feature; nothing if the field turns before the next half-edge.
std::optional<FeatureFan> feature_fan(const SurfaceLinks& links, geometry::HalfEdge first);

// A path from the middle of a half-edge of a feature. Lengths are in sizes.
struct NarrowStrip {
  std::vector<fields::LoopStep> across;  // from the first triangle to the last
  // from the first feature to the centre of the first triangle, and from the centre of the last triangle to the other
  // feature
  double before, after;
  double width;
};

// Nothing if the path meets no feature within `widest`, or one that is not at right angles to it like the first.
std::optional<NarrowStrip> narrow_strip(const SurfaceLinks& links, geometry::HalfEdge from, double widest);

}  // namespace hexpipe::tetmesh::surface
