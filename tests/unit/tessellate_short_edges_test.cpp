#include "tools/tessellate/short_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace hexpipe::tessellate {
namespace {

// A cube of body 1 with a point more on the edge above (0, 0, 0), at `notch`. Tags: 1 below, 2 above, 3 in front (y =
// 0), 4 right, 5 behind, 6 left (x = 0). Curves: 1 the edge with the notch, 2 the one from (0, 0, 0) to the right.
formats::SurfaceSoup notched_cube(const Vec3& notch) {
  formats::SurfaceSoup cube;
  cube.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, notch};
  cube.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 8}, {8, 1, 5}, {8, 5, 4},
                    {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 8}, {3, 8, 4}, {3, 4, 7}};
  cube.tags = {1, 1, 2, 2, 3, 3, 3, 4, 4, 5, 5, 6, 6, 6};
  cube.sides.assign(cube.triangles.size(), {1, 0});
  cube.places.resize(cube.triangles.size());
  std::iota(cube.places.begin(), cube.places.end(), 1);
  cube.curves = {{0, 8}, {8, 4}, {0, 1}};
  cube.curve_tags = {1, 1, 2};
  return cube;
}

// In the bottom face, which it should stand above.
const Vec3 inside_the_bottom{0.003, 0.004, 0};

TEST(ShortEdges, OfNoLengthHaveTheirEndsJoined) {
  for (const auto& [up, expected] : {std::pair(1e-9, 1u), std::pair(1e-7, 0u)}) {
    const formats::SurfaceSoup cube = notched_cube({0, 0, up});
    JoinedSets same(cube.points.size());
    EXPECT_EQ(join_ends_without_length(cube.triangles, cube.points, same), expected);
    EXPECT_EQ(same.of(0) == same.of(8), expected == 1);
    EXPECT_NE(same.of(8), same.of(4));
  }
}

TEST(ShortEdges, AreGoneWhereTrianglesCross) {
  formats::SurfaceSoup cube = notched_cube(inside_the_bottom);
  ASSERT_FALSE(crossings_of_bodies(cube).empty());
  EXPECT_EQ(collapse_short_edges(cube, 0.01), 1);
  EXPECT_TRUE(crossings_of_bodies(cube).empty());
  EXPECT_EQ(cube.points.size(), 8);
  EXPECT_EQ(cube.triangles.size(), 12);
  for (int tag = 1; tag <= 6; ++tag) EXPECT_EQ(std::ranges::count(cube.tags, tag), 2) << tag;
  EXPECT_EQ(cube.sides.size(), 12);
  EXPECT_EQ(cube.places.size(), 12);
  // The end of two curves stays where it is.
  EXPECT_EQ(cube.points[0], (Vec3{0, 0, 0}));
  EXPECT_EQ(cube.curves, (std::vector<formats::CurveEdge>{{0, 4}, {0, 1}}));
  EXPECT_EQ(cube.curve_tags, (std::vector<std::int32_t>{1, 2}));
}

TEST(ShortEdges, StayWhereTheyAreTooLong) {
  formats::SurfaceSoup cube = notched_cube(inside_the_bottom);
  EXPECT_EQ(collapse_short_edges(cube, 0.004), 0);
  EXPECT_EQ(cube.triangles, notched_cube(inside_the_bottom).triangles);
  EXPECT_EQ(cube.points.size(), 9);
}

TEST(ShortEdges, StayWhereNothingCrosses) {
  formats::SurfaceSoup cube = notched_cube({0, 0, 0.001});
  ASSERT_TRUE(crossings_of_bodies(cube).empty());
  EXPECT_EQ(collapse_short_edges(cube, 0.01), 0);
  EXPECT_EQ(cube.triangles.size(), 14);
}

TEST(ShortEdges, OfBodiesThatOverlapStay) {
  formats::SurfaceSoup cubes = notched_cube({0, 0, 0.5}), other = cubes;
  for (const Vec3& p : other.points) cubes.points.push_back({p.x + 0.25, p.y + 0.25, p.z + 0.25});
  for (const Triangle& t : other.triangles) cubes.triangles.push_back({t[0] + 9, t[1] + 9, t[2] + 9});
  cubes.tags.insert(cubes.tags.end(), other.tags.begin(), other.tags.end());
  cubes.sides.resize(cubes.triangles.size(), {2, 0});
  cubes.places.resize(cubes.triangles.size());
  EXPECT_TRUE(crossings_of_bodies(cubes).empty());
  EXPECT_EQ(collapse_short_edges(cubes, 10), 0);
  EXPECT_EQ(cubes.triangles.size(), 28);
}

}  // namespace
}  // namespace hexpipe::tessellate
