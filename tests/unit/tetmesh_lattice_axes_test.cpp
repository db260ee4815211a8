#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/solid/model_axes.hpp"
#include "tools/tetmesh/volume/lattice.hpp"

namespace hexpipe {
using namespace tetmesh::solid;
using namespace tetmesh::volume;
namespace {

using testing::box;
using testing::cube;
using testing::Facet;
using testing::Facets;
using testing::joined;
using testing::sphere;
using testing::surface_of;

using Axes = std::array<Vec3, 3>;

constexpr Axes coordinate_axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

// Turned by angles about z, then x.
Axes turned_axes(double about_z, double about_x) {
  const double c = std::cos(about_z), s = std::sin(about_z), d = std::cos(about_x), t = std::sin(about_x);
  return {Vec3{c, s * d, s * t}, Vec3{-s, c * d, c * t}, Vec3{0, -t, d}};
}

Facets turned(Facets facets, const Axes& axes) {
  for (Facet& facet : facets)
    for (Vec3& p : facet) p = p.x * axes[0] + p.y * axes[1] + p.z * axes[2];
  return facets;
}

// A prism over a regular polygon, from z = 0 to `height`.
Facets regular_prism(int sides, double radius, double height) {
  Facets facets;
  const auto corner = [&](int i, double z) {
    const double angle = 0.3 + 2 * std::numbers::pi * (i % sides) / sides;
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), z};
  };
  for (int i = 0; i < sides; ++i) {
    const Vec3 a = corner(i, 0), b = corner(i + 1, 0), c = corner(i + 1, height), d = corner(i, height);
    facets.insert(facets.end(),
                  {Facet{a, b, c}, Facet{a, c, d}, Facet{b, a, Vec3{0, 0, 0}}, Facet{d, c, Vec3{0, 0, height}}});
  }
  return facets;
}

TEST(PartAxes, AreTheCoordinateAxesWherePartsAreAlongThese) {
  EXPECT_EQ(axes_of_model(surface_of(box({1, 2, 3}, {2, 5, 9}, 3))), coordinate_axes);
  const Facets step = joined(box({0, 0, 0}, {4, 4, 1}), turned(box({9, 0, 0}, {11, 1, 1}), turned_axes(0.4, 0.3)));
  EXPECT_EQ(axes_of_model(surface_of(step)), coordinate_axes);
}

TEST(PartAxes, AreTheCoordinateAxesWhereNothingIsFlat) {
  EXPECT_EQ(axes_of_model(surface_of(sphere({0, 0, 0}, 1, 12))), coordinate_axes);
}

TEST(PartAxes, FollowTheFlatFaces) {
  for (const double angle : {0.01, 0.3, 0.7}) {
    const Axes wanted = turned_axes(angle, angle / 2);
    const Axes found = axes_of_model(surface_of(turned(box({0, 0, 0}, {3, 2, 1}, 2), wanted)));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(dot(found[i], wanted[i]), 1, 1e-12) << angle << " " << i;
  }
}

TEST(PartAxes, FollowTheLargestFacesOfSeveral) {
  const Axes wanted = turned_axes(0.5, 0.2);
  const Facets parts = joined(turned(cube(0, 4), wanted), cube(20, 3));
  const Axes found = axes_of_model(surface_of(parts));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(std::abs(dot(found[i], wanted[i])), 1, 1e-12);
}

// A prism of seven sides has no faces at right angles to each other but its ends.
TEST(PartAxes, TakeEndsAndASideOfAPrism) {
  const Axes wanted = turned_axes(0.2, 0.6);
  const Axes found = axes_of_model(surface_of(turned(regular_prism(7, 1, 0.5), wanted)));
  EXPECT_NEAR(std::abs(dot(found[2], wanted[2])), 1, 1e-12);
  EXPECT_NEAR(det(found[0], found[1], found[2]), 1, 1e-12);
}

TEST(Lattice, TurnsWithItsAxes) {
  const Axes axes = turned_axes(0.4, 0.9);
  const Facets part = box({0, 0, 0}, {1, 2, 4});
  LatticeOptions options{.size = 0.26, .clearance = 0.6, .jitter = 0};
  const auto straight = lattice_points(surface_of(part), options);
  options.axes = axes;
  const auto points = lattice_points(surface_of(turned(part, axes)), options);
  ASSERT_EQ(points.size(), straight.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = straight[i];
    EXPECT_LT(norm(points[i] - (p.x * axes[0] + p.y * axes[1] + p.z * axes[2])), 1e-12);
  }
}

}  // namespace
}  // namespace hexpipe
