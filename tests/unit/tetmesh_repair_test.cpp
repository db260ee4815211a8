#include "tools/tetmesh/solid/repair.hpp"

#include <gtest/gtest.h>

#include <ranges>
#include <set>

#include "common/run/error.hpp"
#include "common/run/random.hpp"
#include "surface_samples.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/solid/hole_filling.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::solid;
namespace geometry = tetmesh::geometry;
namespace {

using testing::box;
using testing::cube;
using testing::Facets;
using testing::inverted;
using testing::joined;
using testing::soup_of;
using testing::sphere;

double volume_of(const SurfaceSoup& soup) {
  double volume = 0;
  for (const auto& [a, b, c] : soup.triangles) volume += det(soup.points[a], soup.points[b], soup.points[c]) / 6;
  return volume;
}

// Repairs, and expects the boundary of a solid.
RepairReport repaired(SurfaceSoup& soup, const RepairOptions& options = {}) {
  EXPECT_THROW(check_surface(soup), DataError);
  const RepairReport report = repair(soup, options);
  EXPECT_NO_THROW(check_surface(soup));
  EXPECT_EQ(soup.tags.size(), soup.triangles.size());
  EXPECT_EQ(soup.places.size(), soup.triangles.size());
  return report;
}

TEST(Repair, OfTrianglesWithoutAreaNothingIsLeft) {
  SurfaceSoup soup = soup_of(Facets{{Vec3{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}});
  EXPECT_THROW(repair(soup, {}), DataError);
}

TEST(Repair, LeavesAGoodSurfaceAsItIs) {
  SurfaceSoup soup = soup_of(joined(cube(0, 3, 3), inverted(cube(1, 1, 2))));
  const SurfaceSoup before = soup;
  EXPECT_FALSE(repair(soup, {.tolerance = 1e-6}).anything());
  EXPECT_EQ(soup.points, before.points);
  EXPECT_EQ(soup.triangles, before.triangles);
}

TEST(Repair, WeldsPointsWithinTheTolerance) {
  Facets facets = sphere({0, 0, 0}, 1, 8);
  Random random(1);
  for (auto& facet : facets)
    for (Vec3& p : facet) p += {random.uniform(-1e-5, 1e-5), random.uniform(-1e-5, 1e-5), random.uniform(-1e-5, 1e-5)};
  SurfaceSoup soup = soup_of(facets);
  const std::size_t loose = soup.points.size();
  const RepairReport report = repaired(soup, {.tolerance = 1e-4});
  EXPECT_EQ(soup.points.size(), 2u + 7 * 16);
  EXPECT_EQ(report.welded_points, loose - soup.points.size());
}

TEST(Repair, RemovesRepeatedTriangles) {
  Facets facets = cube(0, 1, 2);
  facets.push_back(facets[3]);
  facets.push_back(inverted({facets[5]})[0]);
  SurfaceSoup soup = soup_of(facets);
  EXPECT_EQ(repaired(soup).duplicate_triangles, 2u);
  EXPECT_EQ(soup.triangles.size(), 48u);
}

TEST(Repair, CutsTheNeighbourOfAFlatTriangle) {
  // The first square's diagonal is halved on one side only, and a flat triangle fills the gap.
  Facets facets = cube();
  const auto [a, b, c] = facets[0];
  const Vec3 middle = 0.5 * (a + c);
  facets[0] = {a, b, middle};
  facets.push_back({middle, b, c});
  facets.push_back({a, middle, c});
  SurfaceSoup soup = soup_of(facets);
  EXPECT_EQ(repaired(soup).degenerate_triangles, 1u);
  EXPECT_NEAR(volume_of(soup), 1, 1e-12);
}

TEST(Repair, TurnsTrianglesAndWholePieces) {
  Facets facets = joined(cube(0, 1, 3), inverted(cube(5, 1, 2)));
  std::swap(facets[7][1], facets[7][2]);
  SurfaceSoup soup = soup_of(facets);
  EXPECT_EQ(repaired(soup).turned_triangles, 1u + 48);
  EXPECT_NEAR(volume_of(soup), 2, 1e-12);
}

TEST(Repair, KeepsHolesThatLieInMaterial) {
  Facets facets = joined(cube(0, 3, 1), inverted(cube(1, 1, 1)));
  facets.push_back(facets[0]);
  SurfaceSoup soup = soup_of(facets);
  EXPECT_EQ(repaired(soup).turned_triangles, 0u);
  EXPECT_NEAR(volume_of(soup), 26, 1e-12);
}

TEST(Repair, FillsHolesUpToTheirLimit) {
  Facets facets = cube(0, 1, 4);
  facets.erase(facets.begin() + 3, facets.begin() + 5);
  facets.pop_back();
  const SurfaceSoup torn = soup_of(facets);
  SurfaceSoup soup = torn;
  const RepairReport report = repaired(soup);
  EXPECT_GE(report.filled_holes, 2u);
  EXPECT_EQ(report.hole_triangles, 3u);
  EXPECT_NEAR(volume_of(soup), 1, 1e-12);
  soup = torn;
  EXPECT_EQ(repair(soup, {.largest_hole = 2}).filled_holes, 0u);
  EXPECT_THROW(check_surface(soup), DataError);
}

// In whatever order the walk around them meets their edges.
TEST(Repair, FillsHolesThatTouchInAVertex) {
  const SurfaceSoup whole = soup_of(cube(0, 1, 3));
  Random random(7);
  int touching = 0;
  for (std::size_t i = 0; i < whole.triangles.size(); ++i)
    for (std::size_t j = i + 1; j < whole.triangles.size(); ++j) {
      const Triangle &one = whole.triangles[i], &other = whole.triangles[j];
      const auto shared =
          std::ranges::count_if(one, [&](Vertex v) { return std::ranges::find(other, v) != other.end(); });
      if (shared != 1) continue;
      ++touching;
      SurfaceSoup soup = whole;
      for (const std::size_t t : {j, i}) {
        soup.triangles.erase(soup.triangles.begin() + static_cast<std::ptrdiff_t>(t));
        soup.tags.pop_back();
        soup.places.pop_back();
      }
      random.shuffle(std::span(soup.triangles));
      const RepairReport report = repaired(soup);
      EXPECT_EQ(report.filled_holes, 2u);
      EXPECT_NEAR(volume_of(soup), 1, 1e-12);
    }
  EXPECT_GT(touching, 100);
}

TEST(HoleFilling, StaysWithinAPolygonThatIsNotConvex) {
  // An arrow: the other diagonal lies outside it.
  const std::vector<Vec3> points{{0, 0, 0}, {2, 1, 0}, {4, 0, 0}, {2, 4, 0}, {2, -4, 0}, {9, 9, 0}};
  const auto triangles = fill_hole(points, std::vector<HoleEdge>{{0, 4}, {1, 4}, {2, 5}, {3, 5}});
  ASSERT_EQ(triangles.size(), 2u);
  double area = 0;
  for (const auto& [a, b, c] : triangles) area += cross(points[b] - points[a], points[c] - points[a]).z / 2;
  EXPECT_DOUBLE_EQ(area, 6);
}

// Around edges and corners of a box, where a triangulation of least area may lie in the faces beside the hole.
TEST(Repair, FillsHolesAcrossEdgesSoThatNothingIntersects) {
  const SurfaceSoup whole = soup_of(box({0, 0, 0}, {1, 2, 3}, 3));
  const auto twins = geometry::find_twins(whole.points.size(), whole.triangles);
  for (std::size_t start = 0; start < whole.triangles.size(); ++start) {
    std::set<std::int32_t> patch{static_cast<std::int32_t>(start)};
    for (int ring = 0; ring < 2; ++ring)
      for (const std::int32_t t : std::set(patch))
        for (int i = 0; i < 3; ++i) patch.insert(geometry::triangle_of(twins[3 * t + i]));
    SurfaceSoup soup = whole;
    for (const std::int32_t t : patch | std::views::reverse) {
      soup.triangles.erase(soup.triangles.begin() + t);
      soup.tags.pop_back();
      soup.places.pop_back();
    }
    const RepairReport report = repaired(soup);
    EXPECT_EQ(report.filled_holes, 1u);
    EXPECT_NEAR(volume_of(soup), 6, 0.5);
  }
}

TEST(Repair, SaysWhatItDid) {
  RepairReport report;
  EXPECT_EQ(report.sentence(), "");
  report.welded_points = 1;
  report.filled_holes = 2;
  report.hole_triangles = 5;
  EXPECT_EQ(report.sentence(), "1 point welded, 2 holes filled by 5 triangles");
}

}  // namespace
}  // namespace hexpipe
