#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tools/wrap/restoring.hpp"
#include "tools/wrap/shrink_wrap.hpp"
#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {
namespace {

// The unit cube, two triangles a side.
Surface cube() {
  Surface surface;
  for (int i = 0; i < 8; ++i) surface.points.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
  for (const std::array<Vertex, 4>& quad :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    surface.triangles.push_back({quad[0], quad[1], quad[2]});
    surface.triangles.push_back({quad[0], quad[2], quad[3]});
  }
  return surface;
}

TEST(TriangleTree, FindsTheNearestPointAndThePlaneThatFaces) {
  const TriangleTree tree(cube());
  EXPECT_NEAR(norm(tree.nearest({0.5, 0.25, 3}).point - Vec3{0.5, 0.25, 1}), 0, 1e-12);
  EXPECT_NEAR(tree.distance({0.5, 0.5, 0.75}), 0.25, 1e-12);
  // At an edge two planes are as near: the one that faces is wanted, turned to its side.
  const Plane top = tree.facing_plane({1, 0.5, 1}, {0.1, 0, 1}, 1e-6),
              side = tree.facing_plane({1, 0.5, 1}, {1, 0, 0.1}, 1e-6);
  EXPECT_NEAR(norm(top.normal - Vec3{0, 0, 1}), 0, 1e-12);
  EXPECT_NEAR(norm(side.normal - Vec3{1, 0, 0}), 0, 1e-12);
}

TEST(Restoring, GivesACubeItsEdgesAndCornersBack) {
  const Surface input = cube();
  const TriangleTree tree(input);
  const Surface wrapped = shrink_wrap(input, 0.1, 0.01);
  const auto furthest = [&](const Surface& surface) {
    return distances(input, TriangleTree(surface), 0.02, 0).greatest;
  };
  EXPECT_GT(furthest(wrapped), 0.009);
  const RestoredSurface restored = restore_shape(wrapped, tree, {0.05, 40});
  EXPECT_TRUE(crossing_triangles(restored.surface).empty());
  EXPECT_EQ(restored.points_off_input, 0U);
  EXPECT_LT(furthest(restored.surface), 0.005);
  EXPECT_LT(distances(restored.surface, tree, 0.02, 0).greatest, 0.005);
}

TEST(Restoring, TakesBackWhatWouldCross) {
  // A fin without thickness: both sides of the wrap would go to the same place.
  Surface fin;
  fin.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  fin.triangles = {{0, 1, 2}, {0, 2, 3}};
  const TriangleTree tree(fin);
  const RestoredSurface restored = restore_shape(shrink_wrap(fin, 0.1, 0.02), tree, {0.05, 40});
  EXPECT_TRUE(crossing_triangles(restored.surface).empty());
  EXPECT_GT(restored.points_off_input, 0U);
}

TEST(Distances, AreGreatestMeanAndShare) {
  Surface square;
  square.points = {{0, 0, 1.5}, {1, 0, 1.5}, {1, 1, 1.5}, {0, 1, 1.5}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  const DistanceSummary summary = distances(square, TriangleTree(cube()), 0.1, 0.4);
  EXPECT_NEAR(summary.greatest, 0.5, 1e-12);
  EXPECT_NEAR(summary.mean, 0.5, 1e-12);
  EXPECT_NEAR(summary.share_beyond, 1, 1e-12);
}

}  // namespace
}  // namespace hexpipe::wrap
