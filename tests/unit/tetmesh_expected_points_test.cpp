#include <gtest/gtest.h>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/sizing/wall_sizes.hpp"
#include "tools/tetmesh/volume/estimates.hpp"
#include "tools/tetmesh/volume/lattice.hpp"

namespace hexpipe {
using namespace tetmesh::sizing;
using namespace tetmesh::solid;
using namespace tetmesh::volume;
namespace {

using testing::box;
using testing::cube;
using testing::sphere;
using testing::surface_of;

constexpr double many = 1e9;

SizeField fine_at(const std::vector<Vec3>& places, double size, double greatest, double grading) {
  SizeSources sources;
  for (const Vec3& p : places) {
    sources.simplices.push_back({static_cast<Vertex>(sources.points.size()), no_index, no_index, no_index});
    sources.points.push_back(p);
    sources.sizes.push_back(size);
  }
  return {std::move(sources), greatest, grading};
}

// Sizes of the vertices, linear on the triangles.
SizeField fine_on(const Surface& surface, double size, double greatest, double grading) {
  SizeSources sources;
  sources.points = surface.points;
  sources.sizes.assign(surface.points.size(), size);
  for (const auto& [a, b, c] : surface.triangles) sources.simplices.push_back({a, b, c, no_index});
  return {std::move(sources), greatest, grading};
}

TEST(PointsInside, AreAboutThoseOfTheLattice) {
  const Surface block = surface_of(cube(0, 8)), ball = surface_of(sphere({1, 2, 3}, 2.5, 14)),
                plate = surface_of(box({0, 0, 0}, {20, 20, 1}));
  const auto expect_about = [](const Surface& surface, const SizeField& size) {
    const auto found = static_cast<double>(graded_lattice_points(surface, size, {}, 1e6).size());
    const double expected = points_inside(surface, size, 0.5, many);
    EXPECT_LT(expected, 3 * found);
    EXPECT_GT(expected, found / 3);
  };
  expect_about(block, fine_at({{0, 0, 0}}, 0.1, 1, 0.2));
  expect_about(block, fine_at({{3, 4, 5}, {8, 8, 8}}, 0.01, 1, 0.3));
  expect_about(block, fine_at({{4, 4, 4}}, 1e-12, 1, 0.3));
  expect_about(block, fine_on(block, 0.2, 2, 0.3));
  expect_about(ball, fine_on(ball, 0.1, 1, 0.2));
  expect_about(plate, fine_at({{10, 10, 0}}, 0.1, 1, 0.3));
  expect_about(plate, {{{}, {}, {}, wall_sizes(plate, 1, 3)}, 1, 0.3});
}

TEST(PointsInside, AreNoneWhereNothingIsClearOfTheSurface) {
  const Surface plate = surface_of(box({0, 0, 0}, {20, 20, 1}));
  EXPECT_EQ(points_inside(plate, fine_at({{40, 40, 0}}, 1, 10, 0.1), 0.5, many), 0);
}

TEST(PointsInside, AreNotCountedBeyondEnough) {
  const Surface block = surface_of(cube(0, 8));
  const double counted = points_inside(block, fine_on(block, 1e-9, 1, 0.3), 0.5, 1000);
  EXPECT_GT(counted, 1000);
  EXPECT_LT(counted, 2000);
}

}  // namespace
}  // namespace hexpipe
