#include "tools/tetmesh/geometry/exact_geometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "surface_samples.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::geometry;
namespace {

using Pair = std::array<std::int32_t, 2>;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};

std::vector<Pair> intersections(const testing::Facets& facets) {
  const SurfaceSoup soup = testing::soup_of(facets);
  return find_intersections(soup.points, soup.triangles, 100).pairs;
}

TEST(ExactGeometry, SignsAreExact) {
  // A neighbouring double off the plane x + y = 1: naive evaluation gives 0 or the wrong sign.
  const double next = std::nextafter(0.5, 1.0);
  EXPECT_EQ(orientation_along_z({0, 1, 0}, {1, 0, 5}, {0.5, 0.5, 9}), 0);
  EXPECT_EQ(orientation_along_z({0, 1, 0}, {1, 0, 5}, {next, 0.5, 9}), 1);
  EXPECT_TRUE(are_collinear({0, 0, 0}, {0.1, 0.2, 0.3}, {0.2, 0.4, 0.6}));
  EXPECT_FALSE(are_collinear({0, 0, 0}, {1, 1, 1}, {2, 2, std::nextafter(2.0, 3.0)}));
}

TEST(ExactGeometry, TrianglesWithoutCommonCorners) {
  EXPECT_THAT(intersections({{a, b, c}, {Vec3{1, 1, -1}, Vec3{1, 1, 1}, Vec3{9, 9, 1}}}), ElementsAre(Pair{0, 1}));
  EXPECT_THAT(intersections({{a, b, c}, {Vec3{1, 1, 1}, Vec3{2, 1, 1}, Vec3{1, 2, 1}}}), IsEmpty());
  // Touching with a corner, and lying in one plane.
  EXPECT_THAT(intersections({{a, b, c}, {Vec3{1, 1, 0}, Vec3{2, 1, 1}, Vec3{1, 2, 1}}}), ElementsAre(Pair{0, 1}));
  EXPECT_THAT(intersections({{a, b, c}, {Vec3{1, 1, 0}, Vec3{8, 1, 0}, Vec3{8, 8, 0}}}), ElementsAre(Pair{0, 1}));
}

TEST(ExactGeometry, TrianglesWithACommonCorner) {
  EXPECT_THAT(intersections({{a, b, c}, {a, Vec3{-1, 0, 0}, Vec3{0, -1, 0}}}), IsEmpty());
  EXPECT_THAT(intersections({{a, b, c}, {a, Vec3{3, 3, -1}, Vec3{3, 3, 1}}}), ElementsAre(Pair{0, 1}));
  EXPECT_THAT(intersections({{a, b, c}, {a, Vec3{1, 1, 0}, Vec3{0, 0, 5}}}), ElementsAre(Pair{0, 1}));
}

TEST(ExactGeometry, TrianglesWithACommonEdge) {
  EXPECT_THAT(intersections({{a, b, c}, {b, a, Vec3{1, -1, 0}}}), IsEmpty());
  EXPECT_THAT(intersections({{a, b, c}, {b, a, Vec3{1, 1, 1}}}), IsEmpty());
  EXPECT_THAT(intersections({{a, b, c}, {b, a, Vec3{1, 1, 0}}}), ElementsAre(Pair{0, 1}));
}

TEST(ExactGeometry, StopsAtTheLimit) {
  const SurfaceSoup soup = testing::soup_of(testing::joined(testing::cube(), testing::cube(0.5)));
  EXPECT_TRUE(find_intersections(soup.points, soup.triangles, 18).complete);
  const IntersectionReport report = find_intersections(soup.points, soup.triangles, 5);
  EXPECT_FALSE(report.complete);
  EXPECT_EQ(report.pairs.size(), 5u);
}

}  // namespace
}  // namespace hexpipe
