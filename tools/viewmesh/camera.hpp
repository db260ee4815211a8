#pragma once
// The camera of a view; page/camera.js has the same one.

#include <array>
#include <span>

#include "tools/viewmesh/skin.hpp"
#include "tools/viewmesh/view_state.hpp"

namespace hexpipe::viewmesh {

using Matrix4 = std::array<float, 16>;  // by columns

struct Camera {
  Matrix4 view, projection;
  Vec3 right, up, towards, eye;  // the picture's axes, and the place from which it is seen
  double distance = 1;           // from the eye to the target
  double near = 0, far = 0;
  std::array<float, 2> half_frustum{};  // tangents of half the angles of view, across and up
};

Camera camera_of(const ViewState& state, double aspect);

// A box in the picture, of which all is [-1, 1] across and up.
struct Frame {
  double left = -1, right = 1, bottom = -1, top = 1;
};

// Sets zoom and target so that the skin just fits into the frame, in its middle. Without a skin the whole scene does.
void fit_camera(ViewState& state, std::span<const SkinVertex> skin, double aspect, const Frame& frame);

// The axes of the plane across `up`, and `up` itself: azimuth counts from the first to the second.
std::array<Vec3, 3> axes_of(const ViewState::Up& up);

// The distance up to which occluders count: a few cells, in the scene's units.
double occlusion_reach(const Scene& scene);

}  // namespace hexpipe::viewmesh
