#include "tools/tetmesh/volume/lattice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "common/run/error.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/geometry/column_index.hpp"

namespace hexpipe {
using namespace tetmesh::geometry;
using namespace tetmesh::sizing;
using namespace tetmesh::solid;
using namespace tetmesh::volume;
namespace {

using testing::box;
using testing::cube;
using testing::Facets;
using testing::inverted;
using testing::joined;
using testing::naive_distance;
using testing::sphere;
using testing::surface_of;

bool in_material(const Surface& surface, const Vec3& p) {
  bool odd = false;
  ColumnIndex(surface.points, surface.triangles).for_each_crossing(p, [&](std::int32_t t) {
    if (surface.shells[surface.shell_of[t]].in_front == outside_region) odd = !odd;
  });
  return odd;
}

// The result of lattice_points, one point at a time: no rasterizing, no flooding.
std::size_t count_naively(const Surface& surface, const LatticeOptions& options) {
  Vec3 low = surface.points[0], high = low;
  for (const Vec3& p : surface.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  auto steps = [&](int axis) { return std::max(1.0, std::round((high[axis] - low[axis]) / options.size)); };
  std::size_t count = 0;
  for (double k = 1; k < steps(2); ++k)
    for (double j = 1; j < steps(1); ++j)
      for (double i = 1; i < steps(0); ++i) {
        const Vec3 p{low.x + i * ((high.x - low.x) / steps(0)), low.y + j * ((high.y - low.y) / steps(1)),
                     low.z + k * ((high.z - low.z) / steps(2))};
        count += naive_distance(surface, p) >= options.clearance * options.size && in_material(surface, p);
      }
  return count;
}

TEST(TriangleDistance, IsThatToTheNearestPoint) {
  const TriangleDistance triangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0});
  EXPECT_DOUBLE_EQ(triangle.squared({1, 1, 2}), 4);  // inside
  EXPECT_DOUBLE_EQ(triangle.squared({1, 1, 0}), 0);
  EXPECT_DOUBLE_EQ(triangle.squared({2, -3, 4}), 25);   // an edge
  EXPECT_DOUBLE_EQ(triangle.squared({-3, -4, 0}), 25);  // a corner
  EXPECT_DOUBLE_EQ(triangle.squared({7, 0, 4}), 25);
  EXPECT_NEAR(triangle.squared({2 + 3, 1.5 + 4, 0}), 25, 1e-12);  // the slanted edge, along its normal
}

TEST(Lattice, FitsAWholeNumberOfStepsToTheBox) {
  const auto points =
      lattice_points(surface_of(box({0, 0, 0}, {1, 2, 4})), {.size = 0.26, .clearance = 0.6, .jitter = 0});
  EXPECT_EQ(points.size(), 3u * 7 * 14);
  EXPECT_EQ(points.front(), Vec3(0.25, 0.25, 4.0 / 15));
  EXPECT_TRUE(std::ranges::is_sorted(points, [](const Vec3& a, const Vec3& b) { return a.z < b.z; }));
}

TEST(Lattice, IsWhatTheDefinitionSays) {
  const Facets hollow = joined(sphere({0, 0, 0}, 3, 10), inverted(sphere({0.4, 0.3, 0.2}, 1.6, 7)));
  const Facets thin = joined(box({-3, -3, 0.05}, {3, 3, 1.1}), cube(0.3, 0.5));
  for (const Facets& facets : {hollow, thin, sphere({1, 2, 3}, 2.5, 14)})
    for (const double clearance : {0.15, 0.4, 0.6, 1.3}) {
      const Surface surface = surface_of(facets);
      const LatticeOptions options{.size = 0.55, .clearance = clearance, .jitter = 0};
      EXPECT_EQ(lattice_points(surface, options).size(), count_naively(surface, options)) << clearance;
    }
}

// The walls of the hole lie halfway between points, which rounding moves away from them in some of the sizes.
TEST(Lattice, WallsHalfwayBetweenPointsHoldTheFlood) {
  for (int i = 0; i < 40; ++i) {
    const double step = 0.3 + 0.01 * i;
    const Surface surface = surface_of(joined(cube(0, 10 * step), inverted(cube(3.5 * step, 3 * step))));
    const LatticeOptions options{.size = 0.97 * step, .clearance = 0.5, .jitter = 0};
    EXPECT_EQ(lattice_points(surface, options).size(), count_naively(surface, options)) << step;
  }
}

TEST(Lattice, KeepsClearOfTheSurface) {
  const Surface surface = surface_of(joined(sphere({0, 0, 0}, 3, 14), sphere({0.4, 0.3, 0.2}, 1.6, 9)));
  const LatticeOptions options{.size = 0.3, .clearance = 0.7, .jitter = 0.1};
  const auto points = lattice_points(surface, options);
  EXPECT_GT(points.size(), 1000u);
  for (const Vec3& p : points) {
    EXPECT_TRUE(in_material(surface, p));
    EXPECT_GE(naive_distance(surface, p), (0.7 - 0.1 * std::sqrt(3)) * 0.3);
  }
}

TEST(Lattice, JitterMovesPointsWithinItsReachBySeed) {
  const Surface surface = surface_of(cube());
  auto points_with = [&](double jitter, std::uint64_t seed) {
    return lattice_points(surface, {.size = 0.1, .clearance = 0.6, .jitter = jitter, .seed = seed});
  };
  const auto exact = points_with(0, 1), jittered = points_with(0.02, 1), other = points_with(0.02, 2);
  ASSERT_EQ(exact.size(), jittered.size());
  double furthest = 0, mean = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) furthest = std::max(furthest, std::abs(exact[i][axis] - jittered[i][axis]));
    mean += (jittered[i] - exact[i]).x / static_cast<double>(exact.size());
  }
  EXPECT_LE(furthest, 0.002 * (1 + 1e-9));
  EXPECT_GT(furthest, 0.0019);
  EXPECT_NEAR(mean, 0, 2e-4);
  EXPECT_EQ(jittered, points_with(0.02, 1));
  EXPECT_NE(jittered, other);
}

SizeField fine_in_a_corner() {
  SizeSources sources;
  sources.points = {{0, 0, 0}};
  sources.sizes = {0.1};
  sources.simplices = {{0, no_index, no_index, no_index}};
  return {sources, 1.0, 0.2};
}

TEST(GradedLattice, IsTheLatticeWhereSizesAreTheSame) {
  const Surface surface = surface_of(sphere({1, 2, 3}, 2.5, 14));
  EXPECT_EQ(graded_lattice_points(surface, 0.4, {}, 1e6), lattice_points(surface, {.size = 0.4}));
}

TEST(GradedLattice, HasStepsThatFollowTheSizes) {
  const Surface surface = surface_of(cube(0, 8));
  const SizeField field = fine_in_a_corner();
  const auto points = graded_lattice_points(surface, field, {.jitter = 0}, 1e6);
  ASSERT_GT(points.size(), 500u);
  for (const Vec3& p : points) {
    const double size = field.at(p);
    EXPECT_GE(naive_distance(surface, p), 0.5 * size);
    double nearest = 100;
    for (const Vec3& q : points)
      if (q != p) nearest = std::min(nearest, norm(p - q));
    EXPECT_GE(nearest, 0.3 * size);  // where lattices meet, the next point is one of the finer
    EXPECT_LE(nearest, 1.24 * size);
  }
}

// None is left out where a cell of the octree is not halved and its neighbour is.
TEST(GradedLattice, HasAllPointsOfItsLattices) {
  const SizeField field = fine_in_a_corner();
  const auto points = graded_lattice_points(surface_of(cube(0, 8)), field, {.clearance = 0.1, .jitter = 0}, 1e6);
  const auto step_at = [&](const Vec3& p) {
    return std::exp2(-std::max(0.0, std::ceil(std::log2(1 / field.at(p)) - 0.3)));
  };
  std::size_t expected = 0;
  constexpr int n = 8 * 16;  // the finest steps are a sixteenth
  for (int i = 1; i < n; ++i)
    for (int j = 1; j < n; ++j)
      for (int k = 1; k < n; ++k) {
        const Vec3 p{i / 16.0, j / 16.0, k / 16.0};
        const double step = step_at(p), sixteenths = 16 * step;
        expected += std::fmod(i, sixteenths) == 0 && std::fmod(j, sixteenths) == 0 && std::fmod(k, sixteenths) == 0;
      }
  EXPECT_EQ(points.size(), expected);
}

// Halves of the part's own extent, along each axis.
TEST(GradedLattice, IsNoFinerForAGreatestSizeBeyondThePart) {
  SizeSources sources;
  for (const double x : {0.0, 8.0})
    for (const double y : {0.0, 8.0}) {
      sources.simplices.push_back({static_cast<Vertex>(sources.points.size()), no_index, no_index, no_index});
      sources.points.push_back({x, y, 0});
      sources.sizes.push_back(1);
    }
  for (const double thickness : {0.5, 2.0, 4.0})
    for (const double greatest : {1.0, 2.0, 7.0, 16.0, 100.0, 1e12}) {
      const Surface plate = surface_of(box({0, 0, 0}, {8, 8, thickness}));
      const auto points = graded_lattice_points(plate, {sources, greatest, 1e-6}, {.clearance = 0.1, .jitter = 0}, 1e6);
      const auto levels = [](const auto& coordinate, const auto& from) {
        std::set<double> values;
        for (const Vec3& p : from) values.insert(coordinate(p));
        return values.size();
      };
      EXPECT_EQ(levels([](const Vec3& p) { return p.x; }, points), thickness < 1 ? 0u : 7u) << thickness << greatest;
      EXPECT_EQ(levels([](const Vec3& p) { return p.z; }, points), thickness < 1 ? 0u : thickness - 1) << greatest;
    }
}

TEST(GradedLattice, RefusesMorePointsThanAllowed) {
  EXPECT_THAT([&] { graded_lattice_points(surface_of(cube(0, 8)), fine_in_a_corner(), {}, 300); },
              ::testing::ThrowsMessage<DataError>(::testing::HasSubstr("at most 300 points inside")));
}

TEST(Lattice, NoPointsWhereTheBoxIsThin) {
  EXPECT_TRUE(lattice_points(surface_of(box({0, 0, 0}, {10, 10, 1})), {.size = 1}).empty());
  EXPECT_TRUE(lattice_points(surface_of(cube()), {.size = 100}).empty());
}

TEST(Lattice, RefusesMorePointsThanMemoryHolds) {
  const Surface surface = surface_of(cube());
  for (const double size : {1e-4, 1e-300})
    EXPECT_THAT([&] { lattice_points(surface, {.size = size}); },
                ::testing::ThrowsMessage<DataError>(::testing::HasSubstr("part: expected a size")));
}

}  // namespace
}  // namespace hexpipe
