// The camera of viewmesh: what it sees, how it fits, and which way is up.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/unit/viewmesh_lattice.hpp"
#include "tools/viewmesh/camera.hpp"
#include "tools/viewmesh/skin.hpp"

namespace hexpipe {
using namespace viewmesh;
namespace {

// Where a point is in the picture, from -1 to 1.
std::array<double, 2> seen_at(const Camera& camera, const Vec3& p) {
  const Vec3 from = p - camera.eye;
  const double depth = -dot(from, camera.towards);
  return {dot(from, camera.right) / depth / camera.half_frustum[0],
          dot(from, camera.up) / depth / camera.half_frustum[1]};
}

// The part of the picture that the skin takes.
Frame frame_of(const std::vector<SkinVertex>& skin, const Camera& camera) {
  Frame frame{9, -9, 9, -9};
  for (const SkinVertex& vertex : skin) {
    const auto [x, y] = seen_at(camera, {vertex.position[0], vertex.position[1], vertex.position[2]});
    frame.left = std::min(frame.left, x), frame.right = std::max(frame.right, x);
    frame.bottom = std::min(frame.bottom, y), frame.top = std::max(frame.top, y);
  }
  return frame;
}

// The corners of a box lie on the ball of radius 1.
TEST(Camera, SeesTheWholeScene) {
  std::vector<Vec3> places{{0, 0, 0}};
  for (int i = 0; i < 60; ++i)
    for (int j = -15; j <= 15; ++j) {
      const double around = i * std::numbers::pi / 30, up = j * std::numbers::pi / 30;
      places.push_back({std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)});
    }
  for (const double aspect : {0.5, 1.0, 1.8})
    for (const double elevation : {ViewState{}.elevation, 90.0}) {
      ViewState state;
      state.elevation = elevation;
      const Camera camera = camera_of(state, aspect);
      for (const Vec3& p : places) {
        std::array<double, 4> at{p.x, p.y, p.z, 1}, eye{}, clip{};
        for (int row = 0; row < 4; ++row)
          for (int k = 0; k < 4; ++k) eye[row] += camera.view[4 * k + row] * at[k];
        for (int row = 0; row < 4; ++row)
          for (int k = 0; k < 4; ++k) clip[row] += camera.projection[4 * k + row] * eye[k];
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_LT(std::abs(clip[axis] / clip[3]), 1 + 1e-6) << p.x << " " << p.y << " " << p.z;
        EXPECT_GT(-eye[2], camera.near);
        EXPECT_LT(-eye[2], camera.far);
      }
    }
}

// It touches the frame on two opposite sides, is about in the middle the other way, and never beyond.
TEST(Camera, FitsWhatIsShownIntoAFrame) {
  const Scene scene = lattice_scene(4);
  for (const double aspect : {0.6, 1.0, 2.0})
    for (const Frame frame : {Frame{}, Frame{-0.9, 0.3, -0.9, 0.9}})
      for (const double elevation : {0.0, 28.0, 90.0})
        for (const bool is_clipped : {false, true}) {
          ViewState state;
          state.elevation = elevation;
          if (is_clipped) state.clip = {{1, 0, 0}, 0.3};
          const auto skin = visible_skin(scene, state);
          fit_camera(state, skin, aspect, frame);
          const Frame seen = frame_of(skin, camera_of(state, aspect));
          const double left = seen.left - frame.left, right = frame.right - seen.right;
          const double bottom = seen.bottom - frame.bottom, top = frame.top - seen.top;
          EXPECT_NEAR(left, right, 0.2);
          EXPECT_NEAR(bottom, top, 0.2);
          EXPECT_NEAR(std::min(std::max(left, right), std::max(bottom, top)), 0, 1e-4);
          EXPECT_GT(std::min({left, right, bottom, top}), -1e-4);
        }
}

TEST(Camera, FitsTheWholeSceneWhereNothingIsShown) {
  ViewState state;
  state.zoom = 7, state.target = {1, 2, 3};
  fit_camera(state, {}, 1, {});
  EXPECT_EQ(state.zoom, 1);
  EXPECT_EQ(state.target, Vec3{});
}

TEST(Camera, HasTheChosenAxisUp) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool turned : {false, true}) {
      ViewState state;
      state.up = {axis, turned};
      const auto [first, second, above] = axes_of(state.up);
      EXPECT_EQ(above[axis], turned ? -1 : 1);
      EXPECT_EQ(det(first, second, above), 1);
      const Camera camera = camera_of(state, 1);
      EXPECT_GT(dot(camera.up, above), 0.8);
      EXPECT_NEAR(dot(camera.right, above), 0, 1e-12);
      EXPECT_NEAR(det(camera.right, camera.up, camera.towards), 1, 1e-12);
    }
}

}  // namespace
}  // namespace hexpipe
