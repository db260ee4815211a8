#include "tools/tetmesh/sizing/sizing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/run/error.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/sizing/wall_sizes.hpp"

namespace hexpipe {
using namespace tetmesh::sizing;
using namespace tetmesh::solid;
namespace {

using testing::box;
using testing::cube;
using testing::sphere;
using testing::surface_of;

TEST(Sizing, ParsesLengths) {
  EXPECT_EQ(parse_length("2.5").value, 2.5);
  EXPECT_FALSE(parse_length("2.5").percent_of_diagonal);
  EXPECT_EQ(parse_length("3%").value, 3);
  EXPECT_TRUE(parse_length("3%").percent_of_diagonal);
  for (const char* bad : {"", "%", "0", "-1", "nan", "inf", "1mm", "3%%", "1e999", " 1"})
    EXPECT_THROW(parse_length(bad), UsageError) << bad;
}

TEST(Sizing, TakesTheLengthAsItIsOrOfTheDiagonal) {
  const Surface surface = surface_of(box({0, 0, 0}, {2, 3, 6}));
  EXPECT_DOUBLE_EQ(bounding_box_diagonal(surface), 7);
  EXPECT_DOUBLE_EQ(element_size(surface, Length{0.3, false}), 0.3);
  EXPECT_DOUBLE_EQ(element_size(surface, Length{2, true}), 0.14);
}

TEST(Sizing, DefaultsToTheSpacingOfTheSurface) {
  EXPECT_NEAR(element_size(surface_of(cube(0, 10, 30)), {}), 1.0 / 3, 0.001);
}

TEST(Sizing, DefaultsAreBounded) {
  // A tessellation of 8 vertices: 6,000 cubes.
  EXPECT_NEAR(element_size(surface_of(cube()), {}), std::cbrt(1.0 / 6000), 1e-12);
  // A rod, of which 5 % of the diagonal would be half of the side.
  EXPECT_NEAR(element_size(surface_of(box({0, 0, 0}, {20, 2, 2})), {}), std::cbrt(80.0 / 6000), 1e-12);
  // A plate: half of its thickness.
  EXPECT_NEAR(element_size(surface_of(box({0, 0, 0}, {100, 100, 1})), {}), 0.5, 0.01);
  // Finer than a million points inside: 1 % of the cube root of the volume.
  const Surface fine = surface_of(cube(0, 1, 128));
  EXPECT_NEAR(element_size(fine, {}), 0.01, 1e-12);
  // A pane of glass: a quarter of a million squares on one side, in place of four million.
  const double area_of_a_side = 5000.0 * 3000 + 2 * 8000;
  EXPECT_NEAR(element_size(surface_of(box({0, 0, 0}, {5000, 3000, 2})), {}), std::sqrt(area_of_a_side / 250'000), 1e-9);
}

TEST(Sizing, ComplainsOfTrianglesFarFromTheSize) {
  const Surface surface = surface_of(cube(0, 1, 10));  // right-angled triangles, sides of 0.1 and 0.14
  EXPECT_NEAR(fit_to_size(surface, 0.1).median_edge, 0.1, 1e-12);
  EXPECT_FALSE(fit_to_size(surface, 0.1).complaint(0.1));
  EXPECT_FALSE(fit_to_size(surface, 0.06).complaint(0.06));
  EXPECT_FALSE(fit_to_size(surface, 0.24).complaint(0.24));
  const SizeFit coarse = fit_to_size(surface, 0.05), fine = fit_to_size(surface, 0.3);
  EXPECT_NEAR(coarse.coarse_share, 1, 1e-12);
  EXPECT_NEAR(fine.fine_share, 1, 1e-12);
  EXPECT_THAT(
      coarse.complaint(0.05).value(),
      ::testing::HasSubstr(
          "100 % of the surface lies in triangles with edges much longer than the size 0.05 (the median edge is 0.1)"));
  EXPECT_THAT(fine.complaint(0.3).value(), ::testing::HasSubstr("much shorter than the size 0.3"));
}

TEST(WallSizes, AreThePartsOfThinWalls) {
  const std::vector<SizePrism> walls = wall_sizes(surface_of(box({0, 0, 0}, {9, 9, 1}, 2)), 2, 4);
  ASSERT_FALSE(walls.empty());
  for (const SizePrism& wall : walls) EXPECT_DOUBLE_EQ(wall.size, 0.25);
  SizeSources sources;
  sources.prisms = walls;
  const SizeField field(sources, 2, 0.3);
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{4, 5, 0.5}, Vec3{8.9, 8.8, 1}, Vec3{9, 4, 0.3}})
    EXPECT_NEAR(field.at(p), 0.25, 1e-9);
  EXPECT_NEAR(field.at({4, 4, 3}), 0.25 + 0.3 * 2, 1e-9);
  EXPECT_TRUE(wall_sizes(surface_of(box({0, 0, 0}, {9, 9, 1}, 2)), 0.5, 2).empty());
  EXPECT_TRUE(wall_sizes(surface_of(cube(0, 9)), 2, 4).empty());
}

TEST(WallSizes, DoNotGoAcrossWhatIsEmpty) {
  // A gap of 0.5 between two blocks of 9.
  const auto blocks = testing::joined(cube(0, 9), box({0, 0, 9.5}, {9, 9, 18.5}));
  EXPECT_TRUE(wall_sizes(surface_of(blocks), 1, 2).empty());
}

double thinnest(std::span<const SizePrism> walls) {
  return std::ranges::min(walls, {}, &SizePrism::size).size;
}

TEST(WallSizes, EndBeforeSharpEdges) {
  // A wedge of 20 degrees with its edge along y.
  const double top = std::tan(20 * std::numbers::pi / 180);
  testing::Facets wedge = box({0, 0, 0}, {4, 4, 1});
  for (testing::Facet& facet : wedge)
    for (Vec3& p : facet) p.z *= top * (0.01 + p.x);
  const std::vector<SizePrism> walls = wall_sizes(surface_of(wedge), 0.5, 2);
  ASSERT_FALSE(walls.empty());
  EXPECT_GE(thinnest(walls), 0.5 / 32);
}

// A box from x = `begin` to 4 that is as high as a wedge with its edge at x = 0 along y.
testing::Facets wedge(double degrees, double begin) {
  testing::Facets facets = box({begin, 0, 0}, {4, 4, 1}, 16);
  for (testing::Facet& facet : facets)
    for (Vec3& p : facet) p.z *= std::tan(degrees * std::numbers::pi / 180) * p.x;
  return facets;
}

TEST(WallSizes, EndBeforeVerySharpEdges) {
  const std::vector<SizePrism> walls = wall_sizes(surface_of(wedge(10, 0.01)), 0.5, 2);
  ASSERT_FALSE(walls.empty());
  EXPECT_GE(thinnest(walls), 0.5 / 32);
}

TEST(WallSizes, AreNoneWhereSidesMeet) {
  for (const double degrees : {20, 30, 40}) {
    // But for the last part of a size, where the edge is cut off.
    for (const SizePrism& wall : wall_sizes(surface_of(wedge(degrees, 0.01)), 0.5, 2))
      for (const Vec3& p : wall.corners) EXPECT_LT(std::max(p.x, p.x + wall.across.x), 0.3) << degrees;
    const std::vector<SizePrism> walls = wall_sizes(surface_of(wedge(degrees, 0.7)), 0.5, 2);
    const double thickness_there = 0.7 * std::tan(degrees * std::numbers::pi / 180);
    ASSERT_FALSE(walls.empty()) << "whose sides would meet outside";
    EXPECT_LT(thinnest(walls), 0.75 * thickness_there);
  }
}

}  // namespace
}  // namespace hexpipe
