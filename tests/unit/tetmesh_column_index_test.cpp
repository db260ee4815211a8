#include "tools/tetmesh/geometry/column_index.hpp"

#include <gtest/gtest.h>

#include "common/run/random.hpp"
#include "surface_samples.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::geometry;
namespace {

using testing::box;
using testing::cube;
using testing::inverted;
using testing::joined;
using testing::soup_of;
using testing::sphere;

bool encloses(const ColumnIndex& index, const Vec3& p) {
  bool odd = false;
  index.for_each_crossing(p, [&](std::int32_t) { odd = !odd; });
  return odd;
}

TEST(ColumnIndex, PointsOfAGridInACubeWhoseVerticesAreOnTheGrid) {
  // Every ray passes through vertices, edges and planes of triangles.
  const SurfaceSoup soup = soup_of(cube(0, 4, 4));
  const ColumnIndex index(soup.points, soup.triangles);
  for (int x = -1; x <= 5; ++x)
    for (int y = -1; y <= 5; ++y)
      for (const double z : {-0.5, 0.5, 2.0, 3.9, 4.5}) {
        const Vec3 p{1.0 * x, 1.0 * y, z};
        const bool on_side = x == 0 || y == 0 || x == 4 || y == 4;
        if (on_side) continue;
        EXPECT_EQ(encloses(index, p), x > 0 && x < 4 && y > 0 && y < 4 && z > 0 && z < 4) << x << ' ' << y << ' ' << z;
      }
}

TEST(ColumnIndex, AgreesWithTheFormulaOnAnOctahedron) {
  // The sphere of two bands is the octahedron |x| + |y| + |z| <= 1.
  const SurfaceSoup soup = soup_of(sphere({0, 0, 0}, 1, 2));
  const ColumnIndex index(soup.points, soup.triangles);
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    Vec3 p;
    p.x = random.uniform(-1.2, 1.2), p.y = random.uniform(-1.2, 1.2), p.z = random.uniform(-1.2, 1.2);
    // Some rays hit an edge or the pole's axis exactly.
    if (i % 5 == 0) p.x = 0;
    if (i % 7 == 0) p.y = 0;
    const double sum = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
    if (std::abs(sum - 1) < 1e-9) continue;
    EXPECT_EQ(encloses(index, p), sum < 1) << p.x << ' ' << p.y << ' ' << p.z;
  }
}

TEST(ColumnIndex, OrientationDoesNotMatterAndShellsCancel) {
  const SurfaceSoup soup = soup_of(joined(inverted(cube(0, 4)), cube(1, 2, 3)));
  const ColumnIndex index(soup.points, soup.triangles);
  EXPECT_TRUE(encloses(index, {0.5, 0.5, 0.5}));
  EXPECT_FALSE(encloses(index, {2, 2, 2}));
  EXPECT_TRUE(encloses(index, {2, 2, 3.5}));
  EXPECT_FALSE(encloses(index, {2, 2, 5}));
}

TEST(ColumnIndex, AWallInOnePlaneOfTheGrid) {
  const SurfaceSoup soup = soup_of(box({0, 0, 0}, {1e-3, 1e-3, 100}, 2));
  const ColumnIndex index(soup.points, soup.triangles);
  EXPECT_TRUE(encloses(index, {5e-4, 5e-4, 50}));
  EXPECT_FALSE(encloses(index, {2e-3, 5e-4, 50}));
}

}  // namespace
}  // namespace hexpipe
