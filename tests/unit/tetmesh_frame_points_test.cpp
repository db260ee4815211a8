#include "tools/tetmesh/volume/frame_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/run/parallel.hpp"
#include "common/run/random.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/fields/octahedral.hpp"
#include "tools/tetmesh/geometry/column_index.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/solid/model_axes.hpp"
#include "tools/tetmesh/solid/surface_clearance.hpp"
#include "tools/tetmesh/volume/lattice.hpp"

namespace hexpipe {
using namespace tetmesh::fields;
using namespace tetmesh::geometry;
using namespace tetmesh::solid;
using namespace tetmesh::tetgen;
using namespace tetmesh::volume;
namespace {

using testing::box;
using testing::Facets;
using testing::inverted;
using testing::joined;
using testing::mesh_of;
using testing::sphere;
using testing::surface_of;

Vec3 random_direction(Random& random) {
  Vec3 v;
  do v = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  while (norm_squared(v) > 1 || norm_squared(v) < 0.1);
  return v * (1 / norm(v));
}

Frame random_frame(Random& random) {
  const Vec3 first = random_direction(random);
  Vec3 second = cross(first, random_direction(random));
  second *= 1 / norm(second);
  return {first, second, cross(first, second)};
}

// The cosine of the angle to the nearest axis.
double cosine_to(const Frame& frame, const Vec3& direction) {
  double greatest = 0;
  for (const Vec3& axis : frame) greatest = std::max(greatest, std::abs(dot(axis, direction)));
  return greatest;
}

TEST(Octahedral, ProductOfTwoDirectionsIsTheLegendrePolynomialOfTheirCosine) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Vec3 a = random_direction(random), b = random_direction(random);
    const double x = dot(a, b);
    EXPECT_NEAR(harmonics_of_axis(a).dot(harmonics_of_axis(b)), (35 * std::pow(x, 4) - 30 * x * x + 3) / 8, 1e-12);
  }
}

TEST(Octahedral, FramesComeBackWhateverTheirOrderAndSigns) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Frame frame = random_frame(random);
    const Harmonics harmonics = harmonics_of(frame);
    EXPECT_NEAR(harmonics.squaredNorm(), frame_norm_squared, 1e-12);
    EXPECT_NEAR((harmonics - harmonics_of({-frame[2], frame[0], -frame[1]})).norm(), 0, 1e-12);
    const Frame found = nearest_frame(harmonics);
    for (const Vec3& axis : found) EXPECT_GT(cosine_to(frame, axis), 1 - 1e-9);
    EXPECT_NEAR(std::abs(det(found[0], found[1], found[2])), 1, 1e-12);
  }
}

TEST(Octahedral, MeanOfTwoNearFramesLiesBetween) {
  const double angle = 0.2;
  const Frame straight{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Frame turned{Vec3{std::cos(angle), std::sin(angle), 0}, {-std::sin(angle), std::cos(angle), 0}, {0, 0, 1}};
  const Frame mean = nearest_frame(harmonics_of(straight) + harmonics_of(turned));
  EXPECT_GT(cosine_to(mean, {std::cos(angle / 2), std::sin(angle / 2), 0}), 1 - 1e-9);
  EXPECT_GT(cosine_to(mean, {0, 0, 1}), 1 - 1e-9);
}

TEST(Octahedral, NoSmallTurnOfTheNearestFrameIsNearer) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Harmonics function = 2 * harmonics_of(random_frame(random)) + harmonics_of(random_frame(random));
    const Frame frame = nearest_frame(function);
    for (std::size_t k = 0; k < 3; ++k)
      for (const double angle : {-0.01, 0.01}) {
        const Vec3 &u = frame[k], &v = frame[(k + 1) % 3], &w = frame[(k + 2) % 3];
        const Frame turned{u, std::cos(angle) * v + std::sin(angle) * w, std::cos(angle) * w - std::sin(angle) * v};
        EXPECT_LT(function.dot(harmonics_of(turned)), function.dot(harmonics_of(frame)));
      }
  }
}

TEST(Octahedral, TheCrossChangesSignByEighthsOfATurn) {
  Random random(3);
  const Frame frame = random_frame(random);
  const Vec3 diagonal = (frame[1] + frame[2]) * std::sqrt(0.5);
  const Harmonics cross_part = harmonics_of_cross(frame[0], frame[1]);
  EXPECT_NEAR(cross_part.norm(), cross_norm, 1e-12);
  EXPECT_NEAR((cross_part + harmonics_of_cross(frame[0], diagonal)).norm(), 0, 1e-12);
  EXPECT_NEAR((harmonics_of(frame) - cross_part - common_part * harmonics_of_axis(frame[0])).norm(), 0, 1e-12);
}

TEST(Octahedral, TurnedOntoADirectionByTheLeastAngle) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Frame frame = random_frame(random);
    const Vec3 direction = random_direction(random);
    const Frame turned = turned_onto(frame, direction);
    EXPECT_NEAR(cosine_to(turned, direction), 1, 1e-12);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_GE(dot(turned[k], frame[k]), cosine_to(frame, direction) - 1e-12);
  }
}

// On how many faces of the box from 0 to 8 a point lies.
int faces_at(const Vec3& p) {
  int faces = 0;
  for (int k = 0; k < 3; ++k) faces += p[k] == 0 || p[k] == 8;
  return faces;
}

// On the mesh of a lattice, as tetmesh does it.
FramePoints place(const Surface& surface, const FramePointsOptions& options) {
  const std::vector<Vec3> lattice = lattice_points(surface, {.size = options.size.greatest()});
  const BuiltMesh background = mesh_of(surface, lattice);
  FrameLattice frame_lattice(surface, background.mesh, background.adjacency, options);
  frame_lattice.fit({});
  return frame_lattice.points_inside(surface);
}

std::vector<Vec3> points_of(const Surface& surface, const FramePointsOptions& options) {
  return place(surface, options).points;
}

// Turns by a rotation matrix without any special angle.
Facets turned(Facets facets) {
  Random random(5);
  const Frame frame = random_frame(random);
  for (auto& facet : facets)
    for (Vec3& p : facet) p = Vec3{dot(frame[0], p), dot(frame[1], p), dot(frame[2], p)};
  return facets;
}

TEST(FramePoints, OfABoxAreTheLatticeOfItsSurfacePoints) {
  const auto points = points_of(surface_of(box({0, 0, 0}, {1, 1, 1}, 8)), {.size = 1. / 8, .jitter = 0});
  EXPECT_EQ(points.size(), 7u * 7 * 7);
  for (const Vec3& p : points)
    for (const double steps : {p.x * 8, p.y * 8, p.z * 8}) EXPECT_NEAR(steps, std::round(steps), 1e-3);
}

// A box of 8 by 8 by 8 sizes whose points on faces are moved along them by up to a third of a size.
Surface box_with_moved_points() {
  Surface surface = surface_of(box({0, 0, 0}, {8, 8, 8}, 8));
  Random random(6);
  for (Vec3& p : surface.points)
    if (faces_at(p) == 1)
      for (double* const x : {&p.x, &p.y, &p.z})
        if (*x > 0.5 && *x < 7.5) *x += random.uniform(-0.33, 0.33);
  return surface;
}

// The mean over points of how far they are from whole numbers.
double distance_from_grid(const std::vector<Vec3>& points) {
  double sum = 0;
  for (const Vec3& p : points)
    for (int k = 0; k < 3; ++k) sum += std::abs(p[k] - std::round(p[k]));
  return sum / (3 * static_cast<double>(points.size()));
}

TEST(FrameLattice, IsHeldByFeaturesAloneOrByAllPointsOfTheSurface) {
  const Surface surface = box_with_moved_points();
  const BuiltMesh background = mesh_of(surface, lattice_points(surface, {.size = 1}));
  FrameLattice lattice(surface, background.mesh, background.adjacency, {.size = 1, .jitter = 0});
  std::vector<bool> on_edges;
  for (const Vec3& p : surface.points) on_edges.push_back(faces_at(p) > 1);
  lattice.fit(on_edges);
  EXPECT_LT(distance_from_grid(lattice.points_inside(surface).points), 0.01);
  const auto guide = lattice.guide();
  EXPECT_EQ(guide.points.size(), 6u * 7 * 7);
  EXPECT_LT(distance_from_grid(guide.points), 0.01);
  const auto [x, y] = guide.coordinates({3.25, 4.5, 8}, {0, 0, 1}, {Vec3{1, 0, 0}, {0, -1, 0}});
  EXPECT_NEAR(coordinate_of(x), 0.25, 0.03);
  EXPECT_NEAR(std::abs(coordinate_of(y)), 0.5, 0.03);
  EXPECT_GT(std::min(std::abs(x), std::abs(y)), 0.9);
  lattice.fit({});
  EXPECT_GT(distance_from_grid(lattice.points_inside(surface).points), 0.02);
}

TEST(FramePoints, StretchWhereTheSurfacePointsAreNotOfTheSize) {
  const auto points = points_of(surface_of(box({0, 0, 0}, {1, 1, 0.9}, 8)), {.size = 1. / 8, .jitter = 0});
  EXPECT_EQ(points.size(), 7u * 7 * 7);
  for (const Vec3& p : points)
    for (const double steps : {p.x * 8, p.y * 8, p.z * 8 / 0.9}) EXPECT_NEAR(steps, std::round(steps), 0.15);
}

TEST(FramePoints, FollowABoxThatLiesAskew) {
  EXPECT_EQ(points_of(surface_of(turned(box({0, 0, 0}, {1, 1, 1}, 8))), {.size = 1. / 8}).size(), 7u * 7 * 7);
}

TEST(FramePoints, TellHowMuchOfThePartALatticeDoesNotFit) {
  const Facets straight = box({0, 0, 0}, {1, 1, 1}, 8);
  EXPECT_EQ(place(surface_of(straight), {.size = 1. / 8}).turned_share, 0);
  EXPECT_EQ(place(surface_of(turned(straight)), {.size = 1. / 8}).turned_share, 1);
  const Surface box_turned = surface_of(turned(straight));
  EXPECT_EQ(place(box_turned, {.size = 1. / 8, .axes = axes_of_model(box_turned)}).turned_share, 0);
  const double round = place(surface_of(sphere({0, 0, 0}, 1, 12)), {.size = 0.2}).turned_share;
  EXPECT_GT(round, 0.3);
  EXPECT_LT(round, 1);
}

TEST(FramePoints, KeepClearOfSurfaceAndOfEachOther) {
  const Surface surface = surface_of(joined(sphere({0, 0, 0}, 3, 14), inverted(sphere({0.2, 0, 0}, 1.2, 8))));
  const FramePointsOptions options{.size = 0.45, .clearance = 0.4, .jitter = 0};
  const auto points = points_of(surface, options);
  EXPECT_GT(points.size(), 600u);
  const ColumnIndex columns(surface.points, surface.triangles);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(is_in_material(surface, columns, points[i]));
    for (const auto& [a, b, c] : surface.triangles)
      ASSERT_GE(TriangleDistance(surface.points[a], surface.points[b], surface.points[c]).squared(points[i]),
                0.4 * 0.4 * 0.45 * 0.45 * (1 - 1e-9));
    // 0.6 steps of the lattice, of which up to 1.45 are as long as the size.
    for (std::size_t j = 0; j < i; ++j) ASSERT_GE(norm(points[i] - points[j]), 0.6 / 1.45 * 0.45 * (1 - 1e-9));
  }
}

TEST(FramePoints, DoNotDependOnTheNumberOfThreads) {
  const Surface surface = surface_of(sphere({0, 0, 0}, 1, 10));
  std::vector<Vec3> single;
  {
    const ThreadLimit limit(1);
    single = points_of(surface, {.size = 0.2});
  }
  const ThreadLimit limit(2);
  EXPECT_EQ(points_of(surface, {.size = 0.2}), single);
}

TEST(FramePoints, JitterComesBySeed) {
  const Surface surface = surface_of(box({0, 0, 0}, {1, 1, 1}, 4));
  const auto points_with = [&](double jitter, std::uint64_t seed) {
    return points_of(surface, {.size = 0.25, .jitter = jitter, .seed = seed});
  };
  const auto exact = points_with(0, 1), jittered = points_with(0.02, 1);
  ASSERT_EQ(exact.size(), jittered.size());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_LE(norm(jittered[i] - exact[i]), 0.02 * 0.25 * std::sqrt(3.0));
    EXPECT_NE(jittered[i], exact[i]);
  }
  EXPECT_NE(points_with(0.02, 2), jittered);
}

TEST(SurfaceClearance, IsTheDistanceToTheNearestTriangle) {
  const Surface surface = surface_of(turned(box({-2, -1, -0.5}, {2, 1, 0.5}, 2)));
  Random random(6);
  const SurfaceClearance clear(surface);
  for (const double clearance : {0.05, 0.3, 0.9}) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
      double least = std::numeric_limits<double>::max();
      for (const auto& [a, b, c] : surface.triangles)
        least = std::min(least, TriangleDistance(surface.points[a], surface.points[b], surface.points[c]).squared(p));
      EXPECT_EQ(clear.is_clear(p, clearance), least >= clearance * clearance);
    }
  }
}

}  // namespace
}  // namespace hexpipe
