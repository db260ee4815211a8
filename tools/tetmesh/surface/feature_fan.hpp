#pragma once
// How a cross field goes on along a feature curve, over one of its vertices.

#include <optional>
#include <vector>

#include "tools/tetmesh/surface/surface_links.hpp"

namespace hexpipe::tetmesh::surface {

// The triangles around a vertex of a feature on one of its sides, where one of the field's directions runs along both
// edges of the feature. Lengths are in sizes.
struct FeatureFan {
  geometry::HalfEdge first;        // begins at the vertex, with the first triangle on its left
  geometry::HalfEdge last;         // ends there, with the last one on its left
  double first_ahead, last_ahead;  // from these triangles' centres to the middles of the two edges, along the curve
  double apart;                    // how much further off the curve the first's centre is than the last's
  std::vector<fields::LoopStep> along, across;  // from the first triangle to the last
};

// Of a half-edge of a feature; none where the field turns on the way to the next one.
std::optional<FeatureFan> feature_fan(const SurfaceLinks& links, geometry::HalfEdge first);

}  // namespace hexpipe::tetmesh::surface
