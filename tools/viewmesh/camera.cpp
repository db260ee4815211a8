#include "tools/viewmesh/camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hexpipe::viewmesh {

Camera camera_of(const ViewState& state, double aspect) {
  constexpr double degree = std::numbers::pi / 180;
  const double half_angle = 14 * degree, azimuth = state.azimuth * degree, elevation = state.elevation * degree;
  const double up_tangent = std::tan(half_angle), across_tangent = up_tangent * aspect;
  // The scene's ball, of radius 1, fits the narrower way at zoom 1: the corners of a box lie on it.
  const double distance = 1 / std::sin(std::atan(up_tangent * std::min(1.0, aspect))) / state.zoom;
  const Vec3 towards{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                     std::sin(elevation)};
  const Vec3 right{-std::sin(azimuth), std::cos(azimuth), 0};
  const Vec3 up = cross(towards, right);
  const Vec3 eye = state.target + distance * towards;

  Camera camera;
  const double reach = 1.05 + norm(state.target);
  camera.near = std::max(distance - reach, 0.002), camera.far = distance + reach;
  camera.half_frustum = {static_cast<float>(across_tangent), static_cast<float>(up_tangent)};
  const std::array rows{right, up, towards};
  camera.view = {};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) camera.view[4 * column + row] = static_cast<float>(rows[row][column]);
    camera.view[12 + row] = static_cast<float>(-dot(rows[row], eye));
  }
  camera.view[15] = 1;
  const double depth = camera.far - camera.near;
  camera.projection = {};
  camera.projection[0] = static_cast<float>(1 / across_tangent);
  camera.projection[5] = static_cast<float>(1 / up_tangent);
  camera.projection[10] = static_cast<float>(-(camera.far + camera.near) / depth);
  camera.projection[11] = -1;
  camera.projection[14] = static_cast<float>(-2 * camera.far * camera.near / depth);
  return camera;
}

double occlusion_reach(const Scene& scene) {
  return std::clamp(2.5 / std::cbrt(static_cast<double>(scene.cell_count())), 0.03, 0.2);
}

}  // namespace hexpipe::viewmesh
