#pragma once
// Three axes at right angles along which most of a model's flat faces lie.

#include <array>

#include "common/mesh/defaults.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

using Axes = std::array<Vec3, 3>;

// The axes are orthonormal and right-handed, and each is as near to its coordinate axis as the model allows. They are
// the coordinate axes themselves unless other axes have more of the surface at right angles to them. Edges where the
// surface turns by more than `feature_angle` degrees are features.
Axes axes_of_model(const Surface& surface, double feature_angle = default_feature_angle);

}  // namespace hexpipe::tetmesh::solid
