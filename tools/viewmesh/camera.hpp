#pragma once
// The camera of a view; page/camera.js has the same one.

#include <array>

#include "tools/viewmesh/view_state.hpp"

namespace hexpipe::viewmesh {

using Matrix4 = std::array<float, 16>;  // by columns

struct Camera {
  Matrix4 view, projection;
  double near = 0, far = 0;
  std::array<float, 2> half_frustum{};  // tangents of half the angles of view, across and up
};

Camera camera_of(const ViewState& state, double aspect);

// The distance up to which occluders count: a few cells, in the scene's units.
double occlusion_reach(const Scene& scene);

}  // namespace hexpipe::viewmesh
