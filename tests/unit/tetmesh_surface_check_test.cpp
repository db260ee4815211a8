#include "tools/tetmesh/solid/surface_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/run/error.hpp"
#include "surface_samples.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::solid;
namespace {

using testing::box;
using testing::cube;
using testing::Facets;
using ::testing::HasSubstr;
using testing::inverted;
using testing::joined;
using testing::soup_of;
using testing::sphere;

std::string error_of(const SurfaceSoup& soup) {
  try {
    check_surface(soup);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}
std::string error_of(const Facets& facets) {
  return error_of(soup_of(facets));
}

TEST(SurfaceCheck, AcceptsClosedSurfaces) {
  EXPECT_EQ(error_of(cube()), "no error");
  EXPECT_EQ(error_of(inverted(cube())), "no error");
  EXPECT_EQ(error_of(sphere({1, 2, 3}, 2, 12)), "no error");
  EXPECT_EQ(error_of(joined(cube(0, 1), cube(2, 1))), "no error");
  EXPECT_EQ(error_of(joined(cube(0, 4), inverted(cube(1, 2)))), "no error");
}

TEST(SurfaceCheck, NamesTheEdgesOfAHole) {
  Facets facets = cube();
  facets.erase(facets.begin() + 2);
  EXPECT_EQ(
      error_of(facets),
      "part: triangle 3: expected a closed surface, found 3 edges of a single triangle; the first is from (1, 0, 0) "
      "to (1, 1, 1)");
}

TEST(SurfaceCheck, NamesLinesOfText) {
  Facets facets = cube();
  facets.pop_back();
  SurfaceSoup soup = soup_of(facets);
  soup.text = true;
  for (std::int64_t& place : soup.places) place += 100;
  EXPECT_THAT(error_of(soup), HasSubstr("part:102: expected a closed surface, found 3 edges"));
}

TEST(SurfaceCheck, NamesFlippedTriangles) {
  Facets facets = cube();
  std::swap(facets[6][0], facets[6][1]);
  EXPECT_THAT(error_of(facets),
              HasSubstr("part: triangle 7: expected neighbours with one orientation, found 1 triangle"));
  std::swap(facets[9][0], facets[9][1]);
  EXPECT_THAT(error_of(facets),
              HasSubstr("part: triangle 7: expected neighbours with one orientation, found 2 triangles"));
}

TEST(SurfaceCheck, AMajorityOfFlippedTrianglesIsTheReference) {
  Facets facets = inverted(cube());
  std::swap(facets[0][0], facets[0][1]);
  EXPECT_THAT(error_of(facets),
              HasSubstr("part: triangle 1: expected neighbours with one orientation, found 1 triangle"));
}

TEST(SurfaceCheck, NamesRepeatedTriangles) {
  Facets facets = cube();
  facets.push_back(facets[4]);
  EXPECT_EQ(error_of(facets),
            "part: triangle 13: expected distinct triangles, found 1 with the corners of another; the first repeats "
            "triangle 5");
  facets.push_back({facets[4][1], facets[4][0], facets[4][2]});
  EXPECT_THAT(error_of(facets), HasSubstr("part: triangle 13: expected distinct triangles, found 2"));
}

TEST(SurfaceCheck, NamesDegenerateTriangles) {
  const std::string expected =
      "part: triangle 13: expected triangles with an area, found 1 without; the first has corners (0, 0, 0), ";
  EXPECT_THAT(error_of(joined(cube(), {{Vec3{0, 0, 0}, Vec3{1, 1, 1}, Vec3{1, 1, 1}}})), HasSubstr(expected));
  EXPECT_THAT(error_of(joined(cube(), {{Vec3{0, 0, 0}, Vec3{1, 1, 1}, Vec3{3, 3, 3}}})), HasSubstr(expected));
  // Collinear as doubles: no area, however it is computed.
  EXPECT_THAT(error_of(joined(cube(), {{Vec3{0, 0, 0}, Vec3{0.1, 0.2, 0.3}, Vec3{0.2, 0.4, 0.6}}})),
              HasSubstr(expected));
}

TEST(SurfaceCheck, NamesEdgesOfMoreThanTwoTriangles) {
  const std::string error = error_of(joined(cube(), box({1, 1, 0}, {2, 2, 1})));
  EXPECT_THAT(error, HasSubstr("expected two triangles at every edge, found 1 edge with more; the first, from"));
  EXPECT_THAT(error, HasSubstr("belongs to triangles"));
}

TEST(SurfaceCheck, NamesVerticesWhereShellsTouch) {
  EXPECT_THAT(
      error_of(joined(cube(), cube(1))),
      HasSubstr("expected one fan of triangles at every vertex, found 1 vertex where several touch; the first is "
                "(1, 1, 1)"));
}

TEST(SurfaceCheck, NamesIntersectingTriangles) {
  EXPECT_THAT(
      error_of(joined(cube(), cube(0.5))),
      HasSubstr("expected a surface that does not intersect itself, found 18 pairs of triangles that do; the first: "
                "triangles "));
}

TEST(SurfaceCheck, NamesUniteWhereBodiesThatPointOutwardOverlap) {
  const auto end_of_error = [](const Facets& facets) {
    try {
      check_surface(soup_of(facets), " (see --repair)");
    } catch (const DataError& error) {
      const std::string text = error.what();
      return text.substr(text.find('('));
    }
    return std::string("no error");
  };
  const Facets overlapping = joined(cube(), cube(0.5));
  EXPECT_EQ(end_of_error(overlapping), "(see --unite)");
  EXPECT_EQ(end_of_error(joined(cube(), inverted(cube(0.5)))), "(see --repair)");
  // Its triangles intersect among themselves, as well as those of the cubes.
  const Vec3 a{9, 0, 0}, b{10, 0, 0}, c{10, 1, 0}, d{9, 1, 0};
  const Facets pillow{{a, b, c}, {a, c, d}, {a, d, b}, {d, c, b}};
  EXPECT_EQ(end_of_error(pillow), "(see --repair)");
  EXPECT_EQ(end_of_error(joined(overlapping, pillow)), "(see --repair, then --unite)");
}

TEST(SurfaceCheck, TouchingFromOutsideIsAnIntersection) {
  EXPECT_THAT(error_of(joined(cube(), box({1, 0.25, 0.25}, {2, 0.75, 0.75}))), HasSubstr("does not intersect itself"));
}

// A square and its back side, cut along different diagonals: closed, manifold, and without any inside.
TEST(SurfaceCheck, APillowWithoutVolumeIsAnIntersection) {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{0, 1, 0};
  EXPECT_THAT(error_of({{a, b, c}, {a, c, d}, {a, d, b}, {d, c, b}}), HasSubstr("does not intersect itself"));
}

TEST(SurfaceCheck, CountsIntersectionsUpToALimit) {
  Facets facets;
  for (int i = 0; i < 40; ++i) facets = joined(facets, cube(i * 0.001));
  EXPECT_THAT(error_of(facets), HasSubstr("found more than 10000 pairs of triangles"));
}

TEST(SurfaceCheck, ASoupInAPlaneIsOpen) {
  EXPECT_THAT(error_of({{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}, {Vec3{2, 0, 0}, Vec3{3, 1, 0}, Vec3{2, 1, 0}}}),
              HasSubstr("expected a closed surface, found 6 edges of a single triangle"));
}

}  // namespace
}  // namespace hexpipe
