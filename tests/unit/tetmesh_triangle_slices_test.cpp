#include "tools/tetmesh/geometry/triangle_boxes.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "common/mesh/apart_test.hpp"
#include "common/run/random.hpp"
#include "formats/surfaces/surface_soup.hpp"
#include "tools/tetmesh/geometry/column_index.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/surface/surface_distance.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::geometry;
using namespace tetmesh::surface;
namespace {

Vec3 place_in_cube(Random& random, double width) {
  const double x = random.uniform(-width, width), y = random.uniform(-width, width);
  return {x, y, random.uniform(-width, width)};
}

Vec3 amid(const Vec3& a, const Vec3& b, const Vec3& c, Random& random) {
  const double u = random.uniform(0, 1), v = random.uniform(0, 1);
  return u + v < 1 ? a + u * (b - a) + v * (c - a) : a + (1 - u) * (b - a) + (1 - v) * (c - a);
}

bool is_in(const Box& box, const Vec3& p) {
  return box.distance(p) == 0;
}

// A cylinder along (1,1,1) of many sides, without its ends: needles that do not lie along the axes.
SurfaceSoup leaning_cylinder(int sides) {
  SurfaceSoup soup;
  const Vec3 axis = unit({1, 1, 1}), across = unit({1, -1, 0}), beside = cross(axis, across);
  for (const double along : {0.0, 50.0})
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      soup.points.push_back(along * axis + 5 * std::cos(angle) * across + 5 * std::sin(angle) * beside);
    }
  for (int i = 0; i < sides; ++i) {
    const int next = (i + 1) % sides;
    soup.triangles.push_back({i, next, sides + next});
    soup.triangles.push_back({i, sides + next, sides + i});
  }
  return soup;
}

TEST(TriangleSlices, OnlyNeedlesOffTheAxesAreCut) {
  EXPECT_EQ(TriangleSlices({0, 0, 0}, {100, 100, 100}, {100, 101, 100}, 1).count(), 173);
  EXPECT_EQ(TriangleSlices({0, 0, 0}, {100, 0, 0}, {100, 0.1, 0}, 1).count(), 1);
  EXPECT_EQ(TriangleSlices({0, 0, 0}, {100, 100, 0}, {0, 100, 50}, 1).count(), 1);
  EXPECT_EQ(TriangleSlices({0, 0, 0}, {100, 100, 100}, {100, 101, 100}, 100).count(), 1);
  EXPECT_LE(TriangleSlices({0, 0, 0}, {100, 100, 100}, {50, 50, 50}, 0).count(), 1024);
  EXPECT_EQ(TriangleSlices({1, 2, 3}, {1, 2, 3}, {1, 2, 3}, 0).count(), 1);
}

TEST(TriangleSlices, CoverTheTriangleAndLieInItsBox) {
  Random random(3);
  int cut = 0;
  for (int i = 0; i < 200; ++i) {
    std::array<Vec3, 3> corners{place_in_cube(random, 100), place_in_cube(random, 100), {}};
    corners[2] = corners[0] + random.uniform(0, 1) * (corners[1] - corners[0]) + place_in_cube(random, 1);
    std::ranges::rotate(corners, corners.begin() + i % 3);
    const auto& [a, b, c] = corners;
    const TriangleSlices slices(a, b, c, 5);
    cut += slices.count() > 1;
    std::vector<Box> boxes;
    slices.for_each_box([&](const Box& box) { boxes.push_back(box); });
    EXPECT_EQ(boxes.size(), static_cast<std::size_t>(slices.count()));
    for (const Box& box : boxes) EXPECT_TRUE(is_in(slices.box(), box.low) && is_in(slices.box(), box.high));
    for (int sample = 0; sample < 300; ++sample) {
      const Vec3 p = sample < 3 ? corners[sample] : amid(a, b, c, random);
      EXPECT_TRUE(std::ranges::any_of(boxes, [&](const Box& box) { return is_in(box, p); }));
    }
  }
  EXPECT_GT(cut, 100);
}

TEST(TriangleSlices, IndicesAndTreesOfNeedlesFindWhatIsThere) {
  const SurfaceSoup soup = leaning_cylinder(200);
  const DistanceIndex index(soup.points, soup.triangles);
  const ColumnIndex columns(soup.points, soup.triangles);
  const BoxTree tree = tree_of_triangles(soup.points, soup.triangles);
  const Vec3 axis = unit({1, 1, 1});
  Random random(9);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random.uniform(0, 50) * axis + place_in_cube(random, 6);
    const auto squared = [&](std::int32_t t) {
      const auto& [a, b, c] = soup.triangles[t];
      return TriangleDistance(soup.points[a], soup.points[b], soup.points[c]).squared(p);
    };
    double nearest = 1e9;
    int above = 0, crossed = 0;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      nearest = std::min(nearest, std::sqrt(squared(static_cast<std::int32_t>(t))));
      // The triangle alone is in one column of its own index.
      const std::vector<Triangle> alone{soup.triangles[t]};
      ColumnIndex(soup.points, alone).for_each_crossing(p, [&](std::int32_t) { ++above; });
    }
    columns.for_each_crossing(p, [&](std::int32_t) { ++crossed; });
    EXPECT_DOUBLE_EQ(index.distance(p), nearest);
    EXPECT_NEAR(tree.least(p, 1, 1e9, [&](std::int32_t t) { return std::sqrt(squared(t)); }), nearest, 1e-8 * nearest);
    EXPECT_EQ(crossed, above);
  }
}

TEST(ApartTest, TrianglesThatMeetAreNeverApart) {
  Random random(11);
  for (int i = 0; i < 20000; ++i) {
    // Whole numbers, so that the point in which the two meet is exact; every third pair lies in one plane.
    const auto place = [&] {
      const Vec3 p = place_in_cube(random, 4);
      return Vec3{std::round(p.x), std::round(p.y), i % 3 == 0 ? 0 : std::round(p.z)};
    };
    const Vec3 a = place(), b = place(), c = place(), d = place(), e = place();
    const Vec3 common = i % 2 == 0 ? 0.5 * (b + c) : 0.25 * a + 0.25 * b + 0.5 * c;
    // In the middle between d and g, and with d and e around it.
    const Vec3 g = 2 * common - d, f = 4 * common - 2 * d - e;
    const std::vector<Vec3> points{a, b, c, d, e, f, g};
    const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}, {0, 3, 6}};
    const ApartTest test(points, triangles);
    EXPECT_FALSE(test.are_apart(0, 1)) << i;
    EXPECT_FALSE(test.are_apart(1, 0)) << i;
    EXPECT_FALSE(test.are_apart_beyond_corner(triangles[0], triangles[2])) << i;
    EXPECT_FALSE(test.are_apart_beyond_corner(triangles[2], triangles[0])) << i;
  }
}

TEST(ApartTest, TellsNeedlesThatDoNotMeet) {
  const SurfaceSoup soup = leaning_cylinder(50);
  const ApartTest test(soup.points, soup.triangles);
  for (std::int32_t t = 8; t < 92; ++t) EXPECT_TRUE(test.are_apart(0, t)) << t;
  const std::vector<Vec3> fan{{0, 0, 0}, {9, 0, 9}, {9, 1, 9}, {9, 2, 9}, {9, 3, 9}};
  const ApartTest beside(fan, {});
  EXPECT_TRUE(beside.are_apart_beyond_corner({0, 1, 2}, {0, 3, 4}));
  EXPECT_FALSE(beside.are_apart_beyond_corner({0, 1, 3}, {0, 2, 4}));
  // One triangle is a hundred times larger: only the plane between their angles separates the two.
  const std::vector<Vec3> unlike{{0, 0, 0}, {100, -100, 0}, {100, -2, 0}, {1, 0, 0}, {1, 1, 0}};
  const ApartTest of_unlike(unlike, {});
  EXPECT_TRUE(of_unlike.are_apart_beyond_corner({0, 1, 2}, {0, 3, 4}));
  EXPECT_TRUE(of_unlike.are_apart_beyond_corner({0, 3, 4}, {0, 1, 2}));
}

}  // namespace
}  // namespace hexpipe
