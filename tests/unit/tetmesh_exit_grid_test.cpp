#include "tools/tetmesh/sizing/exit_grid.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "common/run/random.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/sizing/wall_sizes.hpp"

namespace hexpipe {
using namespace tetmesh::geometry;
using namespace tetmesh::sizing;
using namespace tetmesh::solid;
namespace {

using testing::Facets;
using testing::inverted;
using testing::joined;
using testing::sphere;
using testing::surface_of;

struct Ray {
  Vec3 from, direction;
};

Ray ray_into(const Surface& surface, const Triangle& t) {
  const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
  return {(a + b + c) * (1.0 / 3), -unit(cross(b - a, c - a))};
}

// By a look at every triangle.
bool leaves(const Surface& surface, const Ray& ray, double reach) {
  return std::ranges::any_of(surface.triangles, [&](const Triangle& t) {
    const double length =
        length_to_triangle(ray.from, ray.direction, surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]);
    return length > 1e-9 && length < reach;
  });
}

TEST(DirectionClasses, HoldAllTheirDirectionsInTheirCones) {
  Random random(3);
  for (const int parts : {1, 3, 9}) {
    const DirectionClasses classes(parts);
    EXPECT_EQ(classes.count(), 6 * parts * parts);
    std::vector<bool> seen(static_cast<std::size_t>(classes.count()));
    for (int i = 0; i < 20000; ++i) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
      const int number = classes.of({x, y, z});
      ASSERT_GE(number, 0);
      ASSERT_LT(number, classes.count());
      seen[static_cast<std::size_t>(number)] = true;
      const auto [axis, angle] = classes.cone_of(number);
      EXPECT_LT(angle_between({x, y, z}, axis), angle + 1e-9);
    }
    EXPECT_EQ(std::ranges::count(seen, false), 0);
    // Along the axes, in the planes between them, and along the diagonals.
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          const Vec3 direction{1.0 * x, 1.0 * y, 1.0 * z};
          const auto [axis, angle] = classes.cone_of(classes.of(direction));
          EXPECT_LT(angle_between(direction, axis), angle + 1e-9);
        }
  }
}

// A ball with a hollow ball in it, off the centre: the wall is 0.1 to 0.9 thick.
TEST(ExitGrid, FindsEveryRayThatLeavesAndFewOthers) {
  const Surface surface = surface_of(joined(sphere({0, 0, 0}, 1, 18), inverted(sphere({0.4, 0, 0}, 0.5, 12))));
  for (const double reach : {0.05, 0.3, 0.6}) {
    const ExitGrid grid(surface.points, surface.triangles, reach);
    std::size_t leaving = 0, others = 0, in_vain = 0;
    for (const Triangle& t : surface.triangles) {
      const Ray ray = ray_into(surface, t);
      const bool may_leave = grid.may_leave(ray.from, ray.direction);
      if (leaves(surface, ray, reach)) {
        ++leaving;
        EXPECT_TRUE(may_leave);
      } else {
        ++others;
        in_vain += may_leave;
      }
    }
    EXPECT_EQ(leaving > 0, reach > 0.1) << reach;
    // Where walls are hardly thicker than the reach, cells at the ends of many rays have a part of the other side.
    if (reach < 0.5) {
      EXPECT_LT(in_vain, 0.4 * static_cast<double>(others)) << reach;
    }
  }
}

TEST(ExitGrid, DoesNotKnowTheNormalsOfSlivers) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-7, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}};
  const ExitGrid grid(points, triangles, 0.5);
  EXPECT_TRUE(grid.may_leave({0.5, 0, 0}, {0, 0, 1}));
  EXPECT_TRUE(grid.may_leave({0.5, 0, 0}, {0, 0, -1}));
}

// Where triangles are far smaller than the size, the grid decides which rays are followed.
TEST(WallSizes, AreTheSameOnADenseSurfaceAsByALookAtEveryTriangle) {
  const Surface surface = surface_of(joined(sphere({0, 0, 0}, 1, 18), inverted(sphere({0.4, 0, 0}, 0.5, 12))));
  constexpr double size = 0.6;
  const std::vector<SizePrism> walls = wall_sizes(surface, size, 1);
  std::size_t next = 0;
  for (const Triangle& t : surface.triangles) {
    const Ray ray = ray_into(surface, t);
    if (next < walls.size() && walls[next].corners[0] == surface.points[t[0]] &&
        walls[next].corners[1] == surface.points[t[1]] && walls[next].corners[2] == surface.points[t[2]]) {
      EXPECT_TRUE(leaves(surface, ray, size));
      EXPECT_FALSE(leaves(surface, ray, (1 - 1e-6) * norm(walls[next].across)));
      ++next;
    } else if (leaves(surface, ray, size)) {
      // The other side is turned by more than 45 degrees, or the two meet at an edge: not on the thin side.
      EXPECT_LT(ray.from.x, 0.8);
    }
  }
  EXPECT_EQ(next, walls.size());
  EXPECT_GT(walls.size(), surface.triangles.size() / 8);
}

}  // namespace
}  // namespace hexpipe
