#include "tools/viewmesh/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hexpipe::viewmesh {
namespace {

constexpr double degree = std::numbers::pi / 180;
const double up_tangent = std::tan(14 * degree);  // of half the angle of view
constexpr double greatest_zoom = 200;
// A share of the way to the target; nothing nearer is drawn. Less would leave depths too coarse for occlusion.
constexpr double nearest = 0.1;

// The scene's ball, of radius 1, fits the narrower way at zoom 1: the corners of a box lie on it.
double distance_at(double zoom, double aspect) {
  return 1 / std::sin(std::atan(up_tangent * std::min(1.0, aspect))) / zoom;
}

struct Directions {
  Vec3 right, up, towards;
};

Directions directions_of(const ViewState& state) {
  const double azimuth = state.azimuth * degree, elevation = state.elevation * degree;
  const auto [first, second, above] = axes_of(state.up);
  const Vec3 ahead = std::cos(azimuth) * first + std::sin(azimuth) * second;
  const Vec3 right = -std::sin(azimuth) * first + std::cos(azimuth) * second;
  const Vec3 towards = std::cos(elevation) * ahead + std::sin(elevation) * above;
  return {right, cross(towards, right), towards};
}

// Where the eye has to be, along one way across the picture, for all points to be seen between the tangents `low` and
// `high`: a point at x across and z towards the eye is, if (x - eye) / (depth - z) lies between them.
class Slot {
 public:
  Slot(double low, double high) : low_(low), high_(high) {}
  void add(double across, double towards) {
    least_ = std::min(least_, across + low_ * towards);
    greatest_ = std::max(greatest_, across + high_ * towards);
  }
  double least_depth() const { return (greatest_ - least_) / (high_ - low_); }
  double eye_at(double depth) const { return (greatest_ - high_ * depth + least_ - low_ * depth) / 2; }

 private:
  double low_, high_;
  double least_ = std::numeric_limits<double>::infinity(), greatest_ = -least_;
};

}  // namespace

std::array<Vec3, 3> axes_of(const ViewState::Up& up) {
  constexpr std::array units{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  const Vec3 next = units[(up.axis + 1) % 3], last = units[(up.axis + 2) % 3];
  if (up.turned) return {last, next, -units[up.axis]};
  return {next, last, units[up.axis]};
}

Camera camera_of(const ViewState& state, double aspect) {
  Camera camera;
  camera.distance = distance_at(state.zoom, aspect);
  const auto [right, up, towards] = directions_of(state);
  camera.right = right, camera.up = up, camera.towards = towards;
  camera.eye = state.target + camera.distance * towards;

  const double across_tangent = up_tangent * aspect, reach = 1.05 + norm(state.target);
  camera.near = std::max(camera.distance - reach, nearest * camera.distance), camera.far = camera.distance + reach;
  camera.half_frustum = {static_cast<float>(across_tangent), static_cast<float>(up_tangent)};
  const std::array rows{right, up, towards};
  camera.view = {};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) camera.view[4 * column + row] = static_cast<float>(rows[row][column]);
    camera.view[12 + row] = static_cast<float>(-dot(rows[row], camera.eye));
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

void fit_camera(ViewState& state, std::span<const SkinVertex> skin, double aspect, const Frame& frame) {
  state.zoom = 1, state.target = {};
  if (skin.empty()) return;
  const auto [right, up, towards] = directions_of(state);
  Slot across(frame.left * up_tangent * aspect, frame.right * up_tangent * aspect);
  Slot upwards(frame.bottom * up_tangent, frame.top * up_tangent);
  double back = std::numeric_limits<double>::infinity(), front = -back;
  for (const SkinVertex& vertex : skin) {
    const Vec3 place{vertex.position[0], vertex.position[1], vertex.position[2]};
    const double z = dot(towards, place);
    across.add(dot(right, place), z), upwards.add(dot(up, place), z);
    back = std::min(back, z), front = std::max(front, z);
  }
  const double middle = (back + front) / 2, closest = distance_at(greatest_zoom, aspect);
  const double depth = std::max({across.least_depth(), upwards.least_depth(), middle + closest});
  state.zoom = distance_at(1, aspect) / (depth - middle);
  state.target = across.eye_at(depth) * right + upwards.eye_at(depth) * up + middle * towards;
}

double occlusion_reach(const Scene& scene) {
  return std::clamp(2.5 / std::cbrt(static_cast<double>(scene.cell_count())), 0.03, 0.2);
}

}  // namespace hexpipe::viewmesh
