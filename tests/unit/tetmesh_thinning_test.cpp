#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "common/run/random.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::solid;
using namespace tetmesh::surface;
namespace {

using testing::cube;
using testing::distance_between;
using testing::Facets;
using testing::joined;
using testing::remesh_surface;
using testing::sphere;
using testing::surface_of;

constexpr double sharp_angle = 40;

// As a scanner measures it.
Facets with_noise(Facets facets, double noise) {
  Random random(1);
  SurfaceSoup soup = testing::soup_of(facets);
  for (Vec3& p : soup.points)
    p += Vec3{random.uniform(-noise, noise), random.uniform(-noise, noise), random.uniform(-noise, noise)};
  for (std::size_t t = 0; t < facets.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) facets[t][i] = soup.points[static_cast<std::size_t>(soup.triangles[t][i])];
  return facets;
}

TEST(ThinOut, LeavesFewTrianglesNearTheSurface) {
  for (const double noise : {0.0, 2e-4}) {
    const Surface surface = surface_of(with_noise(sphere({0, 0, 0}, 1, 120), noise));
    const Surface thinned = thin_out(surface, sharp_angle, 0.005, 0.3);
    EXPECT_NO_THROW(check_surface(thinned));
    EXPECT_LT(5 * thinned.triangles.size(), surface.triangles.size());
    EXPECT_LT(distance_between(surface, thinned), 0.006);
    EXPECT_NEAR(thinned.volume(), surface.volume(), 0.005 * 12.6);
    for (const auto& [a, b, c] : thinned.triangles) {
      EXPECT_LT(norm(thinned.points[a] - thinned.points[b]), 0.3);
      EXPECT_LT(norm(thinned.points[b] - thinned.points[c]), 0.3);
    }
  }
}

// Three triangles around a thin neck cannot become two.
TEST(ThinOut, ThinNecksStayManifold) {
  constexpr int rings = 40;
  Facets tube;
  const auto at = [](int ring, int i) {
    const double along = static_cast<double>(ring) / rings, radius = 0.2 + 4 * (along - 0.5) * (along - 0.5);
    return testing::rim_point(3, i, ring == 0 || ring == rings ? 0.5 * radius : radius, 4 * along);
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < 3; ++i) {
      tube.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
      tube.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
    }
  tube.push_back({at(0, 2), at(0, 1), at(0, 0)});
  tube.push_back({at(rings, 0), at(rings, 1), at(rings, 2)});
  const Surface surface = surface_of(tube);
  const Surface thinned = thin_out(surface, 179, 0.5, 4);
  EXPECT_NO_THROW(check_surface(thinned));
  EXPECT_LT(2 * thinned.triangles.size(), surface.triangles.size());
}

TEST(ThinOut, KeepsEdgesTagsShellsAndCurves) {
  Surface surface = surface_of(joined(cube(0, 1, 20), cube(2, 1, 20)));
  // The middle of the top is a curve.
  for (const Triangle& t : surface.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &from = surface.points[t[i]], &to = surface.points[t[(i + 1) % 3]];
      if (from.z == 1 && to.z == 1 && from.x == 0.5 && to.x == 0.5 && from.y < to.y)
        surface.curves.push_back({t[i], t[(i + 1) % 3]}), surface.curve_tags.push_back(4);
    }
  ASSERT_EQ(surface.curves.size(), 20u);
  const Surface thinned = thin_out(surface, sharp_angle, 0.001, 0.3);
  EXPECT_NO_THROW(check_surface(thinned));
  EXPECT_LT(2 * thinned.triangles.size(), surface.triangles.size());
  EXPECT_LT(distance_between(surface, thinned), 1e-12);
  EXPECT_EQ(thinned.shells.size(), 2u);
  EXPECT_NEAR(thinned.volume(), 2, 1e-12);
  EXPECT_EQ(std::set<std::int32_t>(thinned.tags.begin(), thinned.tags.end()), (std::set<std::int32_t>{1, 2}));
  ASSERT_EQ(thinned.curves.size(), 20u);
  for (std::size_t i = 0; i < 20; ++i)
    for (std::size_t end = 0; end < 2; ++end)
      EXPECT_EQ(thinned.points[thinned.curves[i][end]], surface.points[surface.curves[i][end]]);
  // All points of the cubes' edges are there.
  const auto on_edge = [](const Vec3& p) {
    int sides = 0;
    for (int axis = 0; axis < 3; ++axis) sides += p[axis] == 0 || p[axis] == 1 || p[axis] == 2 || p[axis] == 3;
    return sides >= 2;
  };
  EXPECT_EQ(std::ranges::count_if(thinned.points, on_edge), std::ranges::count_if(surface.points, on_edge));
}

// A sum of all steps' distances would stop where the noise adds up to the tolerance.
TEST(ThinOut, NoiseOfAFewHundredthsOfTheToleranceCostsLittle) {
  const Surface smooth = surface_of(sphere({0, 0, 0}, 1, 240));
  const Surface rough = surface_of(with_noise(sphere({0, 0, 0}, 1, 240), 4e-4));
  const std::size_t of_smooth = thin_out(smooth, sharp_angle, 0.006, 0.3).triangles.size();
  EXPECT_LT(thin_out(rough, sharp_angle, 0.006, 0.3).triangles.size(), 2 * of_smooth);
}

// One point of a thousand lies so far out that the edges around it are sharp.
TEST(ThinOut, SharpEdgesOfNoiseAreNoFeatures) {
  Surface surface = surface_of(sphere({0, 0, 0}, 1, 240));
  std::set<double> peaks;  // by x, which no other point has
  for (std::size_t i = 500; i < surface.points.size(); i += 1000) {
    surface.points[i] = 1.012 * surface.points[i];
    peaks.insert(surface.points[i].x);
  }
  const Surface thinned = thin_out(surface, sharp_angle, 0.03, 0.8);
  EXPECT_NO_THROW(check_surface(thinned));
  EXPECT_LT(4 * std::ranges::count_if(thinned.points, [&](const Vec3& p) { return peaks.contains(p.x); }),
            std::ssize(peaks));
}

TEST(ThinOut, ADenseSurfaceIsMeshedLikeAnyOther) {
  const Surface surface = surface_of(with_noise(sphere({0, 0, 0}, 1, 120), 2e-4));
  const RemeshResult result = remesh_surface(surface, {.size = 0.25});
  EXPECT_EQ(result.failure, "");
  EXPECT_NO_THROW(check_surface(result.surface));
  EXPECT_LT(distance_between(surface, result.surface), 0.15 * 0.25);
  EXPECT_GT(result.from_input, 0);
}

}  // namespace
}  // namespace hexpipe
