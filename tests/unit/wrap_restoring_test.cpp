#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tools/wrap/restoring.hpp"
#include "tools/wrap/shrink_wrap.hpp"
#include "tools/wrap/surface.hpp"

namespace hexpipe::wrap {
namespace {

// A solid over a polygon, with the polygon's triangles; each edge of it is sharp.
struct Prism {
  Surface surface;
  std::vector<std::array<Vertex, 2>> edges;
};

Prism prism(const std::vector<std::array<double, 2>>& polygon, const std::vector<Triangle>& triangles, double height) {
  Prism prism;
  const auto count = static_cast<Vertex>(polygon.size());
  for (const double z : {0.0, height})
    for (const auto& [x, y] : polygon) prism.surface.points.push_back({x, y, z});
  for (const auto& [a, b, c] : triangles) {
    prism.surface.triangles.push_back({a, c, b});
    prism.surface.triangles.push_back({a + count, b + count, c + count});
  }
  for (Vertex v = 0; v < count; ++v) {
    const Vertex w = (v + 1) % count;
    prism.surface.triangles.push_back({v, w, w + count});
    prism.surface.triangles.push_back({v, w + count, v + count});
    for (const auto& edge : {std::array{v, w}, {v + count, w + count}, {v, v + count}}) prism.edges.push_back(edge);
  }
  return prism;
}

// The unit cube, two triangles a side.
Prism cube() {
  return prism({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}, 1);
}

// About all three axes; 0: not at all.
Vec3 turned(const Vec3& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const Vec3 about_z{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  const Vec3 about_x{about_z.x, c * about_z.y - s * about_z.z, s * about_z.y + c * about_z.z};
  return {c * about_x.x + s * about_x.z, about_x.y, c * about_x.z - s * about_x.x};
}

TEST(TriangleTree, FindsTheNearestPointAndThePlaneThatFaces) {
  const TriangleTree tree(cube().surface);
  EXPECT_NEAR(norm(tree.nearest({0.5, 0.25, 3}).point - Vec3{0.5, 0.25, 1}), 0, 1e-12);
  EXPECT_NEAR(tree.distance({0.5, 0.5, 0.75}), 0.25, 1e-12);
  // At an edge two planes are as near: the one that faces is wanted, turned to its side.
  const Plane top = tree.facing_plane({1, 0.5, 1}, {0.1, 0, 1}, 1e-6),
              side = tree.facing_plane({1, 0.5, 1}, {1, 0, 0.1}, 1e-6);
  EXPECT_NEAR(norm(top.normal - Vec3{0, 0, 1}), 0, 1e-12);
  EXPECT_NEAR(norm(side.normal - Vec3{1, 0, 0}), 0, 1e-12);
}

// All edges and corners came back, and nothing else is off the input.
bool is_whole(const Prism& solid, double alpha, double offset) {
  const double near = 0.01 * alpha;
  const TriangleTree tree(solid.surface);
  const Surface wrapped = shrink_wrap(solid.surface, alpha, offset);
  EXPECT_GT(distances(solid.surface, TriangleTree(wrapped), 0.02, 0).greatest, 0.9 * offset);
  const RestoredSurface restored = restore_shape(wrapped, tree, {0.75 * alpha, 40});
  EXPECT_TRUE(crossing_triangles(restored.surface).empty());
  const TriangleTree result(restored.surface);
  double furthest =
      std::max(distances(solid.surface, result, 0.02, 0).greatest, distances(restored.surface, tree, 0.02, 0).greatest);
  for (const auto& [a, b] : solid.edges)
    for (int i = 0; i <= 200; ++i) {
      const double share = i / 200.0;
      const Vec3 at = share * solid.surface.points[a] + (1 - share) * solid.surface.points[b];
      furthest = std::max(furthest, result.distance(at));
    }
  return furthest < near && restored.points_off_input == 0;
}

// At several sizes, offsets and angles. Which of them come out whole differs between releases of CGAL. Of twelve, CGAL 5.5
// leaves one of the cube and one of the L with an edge that is cut, CGAL 6.0 two of the prism of 60 degrees.
void expect_edges_and_corners(const Prism& solid) {
#ifdef __SANITIZE_ADDRESS__
  const std::vector<double> angles{0.4};
#else
  const std::vector<double> angles{0, 0.4, 0.7};
#endif
  int tried = 0, whole = 0;
  for (const double angle : angles)
    for (const double alpha : {0.1, 0.14})
      for (const double offset : {alpha / 30, alpha / 10}) {
        Prism placed = solid;
        for (Vec3& p : placed.surface.points) p = turned(p, angle);
        ++tried;
        whole += is_whole(placed, alpha, offset);
      }
  EXPECT_GE(whole, tried - std::max(1, tried / 6));
}

TEST(Restoring, GivesACubeItsEdgesAndCornersBack) {
  expect_edges_and_corners(cube());
}

TEST(Restoring, GivesEdgesOf60And120DegreesBack) {
  const double h = std::sqrt(0.75);
  expect_edges_and_corners(prism({{0, 0}, {1, 0}, {0.5, h}}, {{0, 1, 2}}, 0.8));
  expect_edges_and_corners(prism({{1, 0}, {0.5, h}, {-0.5, h}, {-1, 0}, {-0.5, -h}, {0.5, -h}},
                                 {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}, 0.7));
}

TEST(Restoring, GivesAnInnerEdgeBack) {
  expect_edges_and_corners(prism({{0, 0}, {1, 0}, {1, 0.4}, {0.4, 0.4}, {0.4, 1}, {0, 1}},
                                 {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}, 0.5));
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
  const DistanceSummary summary = distances(square, TriangleTree(cube().surface), 0.1, 0.4);
  EXPECT_NEAR(summary.greatest, 0.5, 1e-12);
  EXPECT_NEAR(summary.mean, 0.5, 1e-12);
  EXPECT_NEAR(summary.share_beyond, 1, 1e-12);
}

}  // namespace
}  // namespace hexpipe::wrap
