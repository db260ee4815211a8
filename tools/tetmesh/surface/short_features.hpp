#pragma once
// A surface without the features that are too short for its size: each would bring cells as thin as itself.

#include <cstddef>
#include <optional>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::surface {

struct JoinedFeatures {
  solid::Surface surface;
  std::size_t count = 0;  // vertices that went, or joined a feature
};

// Feature curves between corners that are at most as long as `shortest` become points, and strips between features as
// narrow become curves: points on both sides that face each other become one, and others join the feature beside them.
// Every point of the surface moves by `shortest` at most, and by a sixth of the thickness of a wall; no triangle of any
// size turns by more than 60 degrees, and each tag with a name keeps triangles. Joints of sheets stay. Nothing where
// there is none to join, or where the surface would intersect itself without them. Edges that turn by more than
// `feature_angle` degrees are features (feature_mesh.hpp).
std::optional<JoinedFeatures> join_short_features(const solid::Surface& surface, double feature_angle,
                                                  const sizing::SizeField& shortest);

}  // namespace hexpipe::tetmesh::surface
