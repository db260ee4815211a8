#include "tools/tetmesh/solid/shells.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "common/run/error.hpp"
#include "surface_samples.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::solid;
namespace {

using testing::cube;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using testing::Facets;
using ::testing::HasSubstr;
using testing::inverted;
using testing::joined;
using testing::soup_of;
using testing::sphere;

Surface shells_of(const Facets& facets, ShellRule rule = ShellRule::oriented) {
  return find_shells(soup_of(facets), rule);
}

std::string shell_error_of(const Facets& facets) {
  try {
    shells_of(facets);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

// (behind, in front) of each shell.
std::vector<std::pair<int, int>> sides_of(const Surface& surface) {
  std::vector<std::pair<int, int>> sides;
  for (const Shell& shell : surface.shells) sides.emplace_back(shell.behind, shell.in_front);
  return sides;
}

double signed_volume(const Surface& surface, std::int32_t shell) {
  double volume = 0;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto [a, b, c] = surface.triangles[i];
    if (surface.shell_of[i] == shell) volume += det(surface.points[a], surface.points[b], surface.points[c]) / 6;
  }
  return volume;
}

using Sides = std::pair<int, int>;

TEST(Shells, OneShellIsOneRegion) {
  const Surface surface = shells_of(cube(0, 2, 3));
  EXPECT_THAT(sides_of(surface), ElementsAre(Sides(1, 0)));
  EXPECT_NEAR(surface.shells[0].volume, 8, 1e-12);
  EXPECT_EQ(surface.shells[0].triangle_count, 6u * 9 * 2);
  EXPECT_EQ(surface.region_count, 1);
}

TEST(Shells, DisjointShellsAreRegionsInTheOrderOfTheFile) {
  const Surface surface = shells_of(joined(cube(5), cube(0, 2)));
  EXPECT_THAT(sides_of(surface), ElementsAre(Sides(1, 0), Sides(2, 0)));
  EXPECT_THAT(surface.region_volumes(), ElementsAre(0, DoubleNear(1, 1e-12), DoubleNear(8, 1e-12)));
}

TEST(Shells, AnInwardShellInsideIsAHole) {
  const Surface surface = shells_of(joined(inverted(cube(1)), cube(0, 4)));
  EXPECT_THAT(sides_of(surface), ElementsAre(Sides(1, 0), Sides(1, 0)));
  EXPECT_EQ(surface.region_count, 1);
  EXPECT_THAT(surface.region_volumes(), ElementsAre(0, DoubleNear(63, 1e-12)));
  EXPECT_LT(signed_volume(surface, 0), 0);
}

TEST(Shells, AnOutwardShellInsideIsARegion) {
  const Surface surface = shells_of(joined(cube(0, 4), sphere({2, 2, 2}, 1, 8)));
  EXPECT_THAT(sides_of(surface), ElementsAre(Sides(1, 0), Sides(2, 1)));
  const auto volumes = surface.region_volumes();
  EXPECT_NEAR(volumes[1] + volumes[2], 64, 1e-12);
  EXPECT_NEAR(volumes[2], signed_volume(surface, 1), 1e-12);
}

TEST(Shells, NestedTwiceAndThrice) {
  const Facets russian_doll = joined(joined(cube(0, 10), inverted(cube(1, 8))), joined(cube(2, 6), cube(3, 1)));
  EXPECT_THAT(sides_of(shells_of(russian_doll)), ElementsAre(Sides(1, 0), Sides(1, 0), Sides(2, 0), Sides(3, 2)));
  EXPECT_THAT(sides_of(shells_of(russian_doll, ShellRule::regions)),
              ElementsAre(Sides(1, 0), Sides(2, 1), Sides(3, 2), Sides(4, 3)));
  EXPECT_THAT(sides_of(shells_of(russian_doll, ShellRule::holes)),
              ElementsAre(Sides(1, 0), Sides(1, 0), Sides(2, 0), Sides(2, 0)));
}

TEST(Shells, OtherRulesTurnTrianglesToTheirMaterial) {
  const Facets facets = joined(inverted(cube(0, 4)), cube(1));
  EXPECT_THAT(shell_error_of(facets),
              HasSubstr("part: triangle 1: expected a shell that points outward, found 12 triangles"));
  const Surface with_hole = shells_of(facets, ShellRule::holes);
  EXPECT_NEAR(signed_volume(with_hole, 0), 64, 1e-12);
  EXPECT_NEAR(signed_volume(with_hole, 1), -1, 1e-12);
  const Surface with_region = shells_of(facets, ShellRule::regions);
  EXPECT_NEAR(signed_volume(with_region, 0), 64, 1e-12);
  EXPECT_NEAR(signed_volume(with_region, 1), 1, 1e-12);
}

TEST(Shells, AHoleInAHoleIsAnError) {
  EXPECT_THAT(shell_error_of(joined(joined(cube(0, 10), inverted(cube(1, 8))), inverted(cube(2, 6)))),
              HasSubstr("part: triangle 25: expected a shell that points outward"));
}

TEST(Shells, TagsAreTheFilesWhereItTellsTrianglesApart) {
  SurfaceSoup soup = soup_of(joined(cube(), cube(2)));
  const Surface by_shell = find_shells(soup, ShellRule::oriented);
  EXPECT_EQ(by_shell.tags.front(), 1);
  EXPECT_EQ(by_shell.tags.back(), 2);
  soup.tags[3] = 7;
  const Surface by_file = find_shells(soup, ShellRule::oriented);
  EXPECT_EQ(by_file.tags, soup.tags);
}

TEST(Shells, VolumesFarFromTheOriginKeepTheirDigits) {
  EXPECT_NEAR(shells_of(cube(1e6)).shells[0].volume, 1, 1e-9);
}

}  // namespace
}  // namespace hexpipe
