#include "tools/tetmesh/surface/bend_stretch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe {
using namespace tetmesh::surface;
namespace {

using testing::Facet;
using testing::Facets;
using testing::remesh_surface;
using testing::surface_of;

constexpr double size = 1, chord_height = 0.025;

// A bar of so many sides along z from 0 to the length whose radius at height z is radius(z).
template <class Radius>
Facets bar(int length, Radius&& radius, int sides = 90) {
  const auto rim = [&](int i, int j) { return testing::rim_point(sides, i, radius(j / 2.0), j / 2.0); };
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

struct Measured {
  FieldSurface surface;
  CrossField field;
  BendStretch stretch;

  explicit Measured(const Facets& facets, const std::optional<tetmesh::sizing::SizeField>& height = chord_height)
      : surface(refined(facets), size, height), field(cross_field(surface)), stretch(bend_stretch(surface, field)) {}

  static FeatureMesh refined(const Facets& facets) {
    FeatureMesh mesh(surface_of(facets), 40);
    refine_surface(mesh, 1.3 * size, 1e-5);
    return mesh;
  }
  // Calls visit(z, stretch along z, stretch across) for the triangles of the sides.
  template <class Visit>
  void for_sides(Visit&& visit) const {
    for (std::int32_t f = 0; f < static_cast<std::int32_t>(surface.triangles.size()); ++f) {
      const Vec3 &n = surface.normals[f], around = unit(cross(Vec3{0, 0, 1}, n));
      if (std::abs(n.z) > 0.5) continue;
      visit(surface.centres[f].z, stretch.in_direction(f, cross(n, around)), stretch.in_direction(f, around));
    }
  }
};

// By which rows around a bar of this radius have to be closer than the size.
double asked_at(double radius) {
  return size / std::sqrt(8 * chord_height * radius);
}

TEST(BendStretch, KeepsChordsToARoundBar) {
  const Measured measured(bar(20, [](double) { return 2; }));
  measured.for_sides([](double z, double along, double across) {
    EXPECT_NEAR(along, 1, 1e-6) << z;
    EXPECT_NEAR(across, asked_at(2), 0.03 * asked_at(2)) << z;
  });
}

TEST(BendStretch, IsNoneWhereChordsMayLeaveTheSurface) {
  for (const auto& height : {std::optional<tetmesh::sizing::SizeField>(), std::optional<tetmesh::sizing::SizeField>(1)})
    Measured(bar(20, [](double) { return 2; }), height).for_sides([](double, double along, double across) {
      EXPECT_EQ(along, 1);
      EXPECT_EQ(across, 1);
    });
}

TEST(BendStretch, IsNoneWhereTheSurfaceBendsBothWays) {
  const Measured measured(testing::sphere({0, 0, 0}, 2, 24));
  for (const double factor : measured.stretch.factor) EXPECT_EQ(factor, 1);
}

// Of a bar that widens to the right of z = 20, the thin part has no more rows than the wide one, as far as four sizes
// from it.
TEST(BendStretch, IsThatOfTheWidestPlaceNearby) {
  const Measured measured(bar(40, [](double z) { return z < 20 ? 1.5 : 1.5 + 0.1 * (z - 20); }));
  int thin = 0, beside = 0;
  measured.for_sides([&](double z, double, double across) {
    if (z < 15) {
      ++thin;
      EXPECT_NEAR(across, asked_at(1.5), 0.04 * asked_at(1.5)) << z;
    } else if (z > 17 && z < 19) {
      ++beside;
      EXPECT_NEAR(across, asked_at(1.5 + 0.1 * (z + 4 - 20)), 0.05 * across) << z;
    }
  });
  EXPECT_GT(thin, 100);
  EXPECT_GT(beside, 20);
}

// Of 19 points the rim's sides are as long as the size. Those of its ends ask for no more.
TEST(Remesh, LaysRowsCloserAroundABar) {
  const double radius = 3;
  const RemeshResult result = remesh_surface(surface_of(bar(
                                                 8, [&](double) { return radius; }, 60)),
                                             {.size = size, .deviation = 0.05});
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.extra_points, 0u);
  int on_rim = 0;
  for (const Vec3& p : result.surface.points) on_rim += p.z == 0 && std::hypot(p.x, p.y) > 0.99 * radius;
  EXPECT_GE(on_rim, 21);
  EXPECT_LE(on_rim, 19 * asked_at(radius));
}

}  // namespace
}  // namespace hexpipe
