#include "tools/tetmesh/solid/repair.hpp"

#include <gtest/gtest.h>

#include <ranges>
#include <set>

#include "common/run/error.hpp"
#include "common/run/random.hpp"
#include "surface_samples.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/solid/repair_steps.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::solid;
namespace geometry = tetmesh::geometry;
namespace {

using testing::box;
using testing::cube;
using testing::Facet;
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

// A cube with an edge in n parts, of which one is bent inward, so that its face folds over another one.
Facets folded(int n, double depth) {
  const Vec3 from{0, 1, 1}, to{1.0 / n, 1, 1}, bent{0.5 / n, 1 - depth, 1};
  const auto has = [](const Facet& facet, const Vec3& p) { return std::ranges::find(facet, p) != facet.end(); };
  Facets facets;
  for (const Facet& facet : cube(0, 1, n)) {
    const bool is_side = facet[0].y == 1 && facet[1].y == 1 && facet[2].y == 1;
    if (!has(facet, from) || !has(facet, to) || !is_side) {
      facets.push_back(facet);
      continue;
    }
    for (const Vec3& end : {from, to}) {
      Facet part = facet;
      *std::ranges::find(part, end) = bent;
      facets.push_back(part);
    }
    // Between the top and the bent edge.
    Facet gap = facet;
    for (Vec3& p : gap)
      if (p != from && p != to) p = bent;
    facets.push_back(gap);
  }
  return facets;
}

TEST(Repair, MakesFoldedTrianglesAnew) {
  for (const int n : {1, 3}) {
    SurfaceSoup soup = soup_of(folded(n, 1e-5));
    const RepairReport report = repaired(soup);
    EXPECT_EQ(report.mended_folds, 1u) << n;
    EXPECT_NEAR(volume_of(soup), 1, 1e-5) << n;
    EXPECT_EQ(soup.triangles.size(), cube(0, 1, n).size()) << n;
  }
}

// The size that suits a cube of the side 1 is 0.055: a fold as deep as a hundredth of it is mended at once.
TEST(Repair, MakesFoldedTrianglesAnewWithoutBeingAskedIfTheyAreNear) {
  for (const double depth : {1e-5, 5e-4, 1e-3, 3e-3}) {
    SurfaceSoup soup = soup_of(folded(3, depth));
    RepairReport report;
    mend_folds(soup, report);
    EXPECT_EQ(report.mended_folds, depth < 5.5e-4 ? 1u : 0u) << depth;
    if (depth < 5.5e-4)
      EXPECT_NO_THROW(check_surface(soup));
    else
      EXPECT_THROW(check_surface(soup), SelfIntersection);
    EXPECT_EQ(repair(soup, {}).mended_folds, depth < 5.5e-4 ? 0u : 1u) << depth;
  }
}

TEST(Repair, LeavesFoldsAcrossTagsUnlessAsked) {
  SurfaceSoup soup = soup_of(folded(3, 1e-5));
  for (std::size_t t = 0; t < soup.tags.size(); ++t) soup.tags[t] = static_cast<std::int32_t>(t);
  RepairReport report;
  mend_folds(soup, report);
  EXPECT_EQ(report.mended_folds, 0u);
  EXPECT_EQ(repair(soup, {}).mended_folds, 1u);
}

TEST(Repair, LeavesBodiesThatOverlap) {
  SurfaceSoup soup = soup_of(joined(cube(0, 1, 3), cube(0.5, 1, 3)));
  EXPECT_FALSE(repair(soup, {}).anything());
  EXPECT_THROW(check_surface(soup), DataError);
}

// Mends, and expects the boundary of a solid of this volume.
RepairReport mended(SurfaceSoup& soup, double volume) {
  EXPECT_THROW(check_surface(soup), DataError);
  const RepairReport report = mend(soup);
  EXPECT_NO_THROW(check_surface(soup));
  EXPECT_EQ(soup.tags.size(), soup.triangles.size());
  EXPECT_EQ(soup.places.size(), soup.triangles.size());
  EXPECT_NEAR(volume_of(soup), volume, 1e-5 * volume);
  EXPECT_EQ(report.turned_triangles + report.filled_holes, 0u);
  return report;
}

TEST(Mend, LeavesWhatHasNoFaultOrAnother) {
  Facets torn = cube(0, 1, 2), flipped = torn;
  torn.pop_back();
  std::swap(flipped[3][0], flipped[3][1]);
  for (const Facets& facets : {cube(0, 1, 2), torn, flipped, joined(cube(0, 1, 2), cube(1, 1, 2))}) {
    SurfaceSoup soup = soup_of(facets);
    const SurfaceSoup before = soup;
    EXPECT_FALSE(mend(soup).anything());
    EXPECT_EQ(soup.points, before.points);
    EXPECT_EQ(soup.triangles, before.triangles);
  }
}

TEST(Mend, RemovesTrianglesWithoutAreaAndCopies) {
  Facets facets = cube(0, 1, 2);
  facets.push_back(facets[3]);
  facets.push_back({facets[7][1], facets[7][2], facets[7][0]});
  facets.push_back({Vec3{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}});
  SurfaceSoup soup = soup_of(facets);
  const RepairReport report = mended(soup, 1);
  EXPECT_EQ(report.duplicate_triangles, 2u);
  EXPECT_EQ(report.degenerate_triangles, 1u);
}

// Two bodies have the same triangles where they touch, each in its own sense.
TEST(Mend, KeepsTrianglesOfBothSensesAndTheirSides) {
  SurfaceSoup soup = soup_of(joined(box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})));
  soup.triangles.push_back(soup.triangles[0]);
  soup.tags.push_back(0), soup.places.push_back(0);
  soup.sides.assign(soup.triangles.size(), {0, 1});
  EXPECT_FALSE(mend(soup).anything());
  soup.sides.clear();
  EXPECT_EQ(mend(soup).duplicate_triangles, 1u);
  EXPECT_EQ(soup.triangles.size(), 24u);
}

TEST(Mend, JoinsPointsThatDifferByRounding) {
  for (const double offset : {0.0, 1000.0}) {
    Facets facets = box({offset, 0, 0}, {offset + 10, 10, 10}, 3);
    Random random(1);
    const double rounding = 1e-7 * (offset + 10);
    for (auto& facet : facets)
      for (Vec3& p : facet) p.x += random.uniform(-rounding, rounding);
    SurfaceSoup soup = soup_of(facets);
    const std::size_t loose = soup.points.size();
    const std::size_t welded = mended(soup, 1000).welded_points;
    EXPECT_EQ(welded, loose - soup.points.size());
    EXPECT_EQ(soup.points.size(), 56u);
  }
  // What is further apart is no rounding.
  Facets facets = cube(0, 1, 2);
  facets[5][0] += {1e-4, 0, 0};
  SurfaceSoup soup = soup_of(facets);
  EXPECT_FALSE(mend(soup).anything());
}

TEST(Mend, CutsTrianglesWherePointsLieOnTheirEdges) {
  // Each face of the cube in as many squares as its number says: no two have the same points on a common edge.
  Facets facets;
  for (int face = 0; face < 6; ++face) {
    const Facets all = cube(0, 1, face + 1);
    const std::size_t each = all.size() / 6;
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(each) * face;
    facets.insert(facets.end(), begin, begin + static_cast<std::ptrdiff_t>(each));
  }
  SurfaceSoup soup = soup_of(facets);
  const RepairReport report = mended(soup, 1);
  EXPECT_GT(report.cut_borders, 20u);
  EXPECT_EQ(report.welded_points + report.stray_triangles, 0u);
  // Rounded as STL has it.
  for (auto& facet : facets)
    for (Vec3& p : facet) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  soup = soup_of(facets);
  mended(soup, 1);
}

TEST(Mend, RemovesStrays) {
  Facets facets = cube(0, 1, 2);
  facets.push_back({Vec3{3, 0, 0}, {4, 0, 0}, {3, 1, 0}});
  // Back to back.
  facets.push_back({Vec3{5, 0, 0}, {6, 0, 0}, {5, 1, 0}});
  facets.push_back({Vec3{5, 0, 0}, {5, 1, 0}, {6, 0, 0}});
  SurfaceSoup soup = soup_of(facets);
  EXPECT_EQ(mended(soup, 1).stray_triangles, 3u);
  EXPECT_EQ(soup.points.size(), 26u);
}

// A body with a hole is no stray, however small it is.
TEST(Mend, KeepsSmallBodiesWithHoles) {
  for (const Facets& body : {cube(20, 0.1, 1), cube(20, 0.1, 3)})
    for (std::size_t missing = 0; missing < body.size(); ++missing) {
      Facets facets = body;
      facets.erase(facets.begin() + static_cast<std::ptrdiff_t>(missing));
      SurfaceSoup soup = soup_of(joined(cube(0, 10, 2), facets));
      EXPECT_FALSE(mend(soup).anything());
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
