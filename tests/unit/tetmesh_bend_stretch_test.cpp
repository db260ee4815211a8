#include "tools/tetmesh/surface/bend_stretch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe {
using namespace tetmesh::surface;
namespace {

using testing::box;
using testing::Facet;
using testing::Facets;
using testing::remesh_surface;
using testing::surface_of;

constexpr double bend_size = 1, bend_height = 0.025;

// A bar of so many sides along z from 0 to the length whose radius at height z is radius(z). Every other of its rings
// is turned by `shift` sides, so that few edges lie along it.
template <class Radius>
Facets bar(int length, Radius&& radius, int sides = 90, double shift = 0) {
  const auto rim = [&](int i, int j) {
    const double angle = 2 * std::numbers::pi * ((i % sides) + (j % 2) * shift) / sides, r = radius(j / 2.0);
    return Vec3{r * std::cos(angle), r * std::sin(angle), j / 2.0};
  };
  Facets facets;
  for (int i = 0; i < sides; ++i) {
    for (int j = 0; j < 2 * length; ++j) {
      const Vec3 a = rim(i, j), b = rim(i + 1, j), c = rim(i + 1, j + 1), d = rim(i, j + 1);
      facets.insert(facets.end(), {Facet{a, b, c}, Facet{a, c, d}});
    }
    const double end = length;
    facets.insert(facets.end(), {Facet{Vec3{0, 0, 0}, rim(i + 1, 0), rim(i, 0)},
                                 Facet{Vec3{0, 0, end}, rim(i, 2 * length), rim(i + 1, 2 * length)}});
  }
  return facets;
}

struct BentSurface {
  FieldSurface surface;
  CrossField field;
  BendStretch stretch;

  explicit BentSurface(const Facets& facets, const std::optional<tetmesh::sizing::SizeField>& height = bend_height)
      : surface(refined(facets), bend_size, height),
        field(cross_field(surface)),
        stretch(bend_stretch(surface, field)) {}

  static FeatureMesh refined(const Facets& facets) {
    FeatureMesh mesh(surface_of(facets), 40);
    refine_surface(mesh, 1.3 * bend_size, 1e-5);
    return mesh;
  }
  // Calls visit(z, stretch along z, stretch around it) for the triangles of a bar's sides from one height to another.
  template <class Visit>
  void for_sides(double from, double to, Visit&& visit) const {
    int count = 0;
    for (std::int32_t f = 0; f < static_cast<std::int32_t>(surface.triangles.size()); ++f) {
      const Vec3 &n = surface.normals[f], around = unit(cross(Vec3{0, 0, 1}, n));
      const double z = surface.centres[f].z;
      if (std::abs(n.z) > 0.9 || z < from || z > to || std::hypot(surface.centres[f].x, surface.centres[f].y) > 5)
        continue;
      visit(z, stretch.in_direction(f, cross(n, around)), stretch.in_direction(f, around));
      ++count;
    }
    EXPECT_GT(count, 20);
  }
};

// How many times as close as the size rows have to be around a bar of this radius.
double asked_around(double radius) {
  return bend_size / std::sqrt(8 * bend_height * radius);
}

TEST(BendStretch, KeepsChordsToARoundBar) {
  const Facets round = bar(20, [](double) { return 3; });
  const Facets bore = testing::joined(testing::inverted(round), box({-9, -9, -9}, {9, 9, 29}));
  for (const Facets& facets : {round, bore})
    BentSurface(facets).for_sides(0, 20, [](double z, double along, double around) {
      EXPECT_NEAR(along, 1, 1e-6) << z;
      EXPECT_NEAR(around, asked_around(3), 0.03 * asked_around(3)) << z;
    });
}

// Ways along the bar cross edges at a slant, and do not bend there.
TEST(BendStretch, IsThatOfTheBendWhereverEdgesLie) {
  const auto radius = [](double) { return 3; };
  BentSurface(bar(20, radius, 90, 0.5)).for_sides(1, 19, [](double z, double along, double around) {
    EXPECT_NEAR(along, 1, 0.02) << z;
    EXPECT_NEAR(around, asked_around(3), 0.1 * asked_around(3)) << z;
  });
}

TEST(BendStretch, IsNoneWhereChordsMayLeaveTheSurface) {
  for (const auto& height : {std::optional<tetmesh::sizing::SizeField>(), std::optional<tetmesh::sizing::SizeField>(1)})
    BentSurface(bar(20, [](double) { return 3; }), height).for_sides(0, 20, [](double, double along, double around) {
      EXPECT_EQ(along, 1);
      EXPECT_EQ(around, 1);
    });
}

// Barrels that bend by one radius around and by another along their staves: rows across the first would have to be 1.1
// times as close as the size, and across those of the second 1.4 times both ways.
TEST(BendStretch, IsNoneWhereTheSurfaceBendsBothWays) {
  const auto barrel = [](double radius, double of_staves) {
    return bar(4, [=](double z) { return radius - of_staves + std::sqrt(of_staves * of_staves - (z - 2) * (z - 2)); });
  };
  BentSurface(barrel(4, 5 / (1.1 * 1.1))).for_sides(1.5, 2.5, [](double z, double along, double around) {
    EXPECT_NEAR(along, 1, 1e-3) << z;
    EXPECT_NEAR(around, asked_around(4), 0.05 * asked_around(4)) << z;
  });
  BentSurface(barrel(2.5, 5 / (1.4 * 1.4))).for_sides(1.5, 2.5, [](double z, double along, double around) {
    EXPECT_EQ(along, 1) << z;
    EXPECT_EQ(around, 1) << z;
  });
}

// Of a bar that widens beyond z = 20, the thin part has no more rows than the wide one, as far as four sizes from it.
TEST(BendStretch, IsThatOfTheWidestPlaceNearby) {
  const BentSurface bent(bar(30, [](double z) { return z < 20 ? 3 : 3 + 0.2 * (z - 20); }));
  bent.for_sides(0, 15, [](double z, double, double around) {
    EXPECT_NEAR(around, asked_around(3), 0.03 * asked_around(3)) << z;
  });
  const auto asked_at = [](double z) { return asked_around(3 + 0.2 * (z - 20)); };
  bent.for_sides(17.5, 19, [&](double z, double, double around) {
    EXPECT_LT(around, asked_at(z + 3)) << z;
    EXPECT_GT(around, asked_at(z + 6)) << z;
  });
}

// 19 points would be one size apart on the rim, and its flat ends ask for no more.
TEST(Remesh, LaysRowsCloserAroundABar) {
  const double radius = 3;
  const RemeshResult result = remesh_surface(surface_of(bar(
                                                 8, [&](double) { return radius; }, 60)),
                                             {.size = bend_size, .deviation = 0.05});
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.extra_points, 0u);
  int on_rim = 0;
  for (const Vec3& p : result.surface.points) on_rim += p.z == 0 && std::hypot(p.x, p.y) > 0.99 * radius;
  EXPECT_GE(on_rim, 21);
  EXPECT_LE(on_rim, 19 * asked_around(radius));
}

}  // namespace
}  // namespace hexpipe
