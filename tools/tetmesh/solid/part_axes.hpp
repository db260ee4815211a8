#pragma once
// Three axes at right angles along which most of a part's flat faces lie.

#include <array>

#include "common/mesh/feature_angle.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh::solid {

using Axes = std::array<Vec3, 3>;

// Orthonormal, right-handed; each the nearest to its coordinate axis that the part allows. The coordinate axes
// themselves where no others have more of the surface at right angles to them: on parts that are along these, and on
// those without flat faces. Edges where the surface turns by more than `feature_angle` degrees are features.
Axes axes_of_part(const Surface& surface, double feature_angle = default_feature_angle);

}  // namespace hexpipe::tetmesh::solid
