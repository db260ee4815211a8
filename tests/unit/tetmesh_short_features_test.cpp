#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"
#include "tools/tetmesh/surface/short_features.hpp"

namespace hexpipe {
using namespace tetmesh::solid;
using namespace tetmesh::surface;
namespace {

using testing::box;
using testing::distance_between;
using testing::Facets;
using testing::surface_of;

constexpr double sharp_from = 40, shortest = 0.05, length = 4;

// A block whose top comes down, from left to right, in steps at these places; each step is that high.
Surface block_with_steps(const std::vector<double>& places, double height) {
  std::vector<Vec3> profile{{0, 0, 0}, {length, 0, 0}};
  double top = 2;
  profile.push_back({length, top, 0});
  for (auto place = places.rbegin(); place != places.rend(); ++place) {
    profile.push_back({*place, top, 0});
    top += height;
    profile.push_back({*place, top, 0});
  }
  profile.push_back({0, top, 0});
  const Vec3 along{0, 0, length};
  Facets facets;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Vec3 &p = profile[i], &q = profile[(i + 1) % profile.size()];
    facets.push_back({p, q, q + along});
    facets.push_back({p, q + along, p + along});
    if (i == 0 || i + 1 == profile.size()) continue;
    facets.push_back({profile[0], q, p});
    facets.push_back({profile[0] + along, p + along, q + along});
  }
  return surface_of(facets);
}

double shortest_edge(const Surface& surface) {
  double least = std::numeric_limits<double>::max();
  for (const Triangle& t : surface.triangles)
    for (int i = 0; i < 3; ++i) least = std::min(least, norm(surface.points[t[i]] - surface.points[t[(i + 1) % 3]]));
  return least;
}

TEST(ShortFeatures, AStepThatIsTooLowToBeMeshedGoes) {
  const Surface surface = block_with_steps({2}, 0.03);
  const auto joined = join_short_features(surface, sharp_from, shortest);
  ASSERT_TRUE(joined.has_value());
  EXPECT_EQ(joined->count, 2u);  // at either end of the step
  EXPECT_NO_THROW(check_surface(joined->surface));
  EXPECT_EQ(joined->surface.points.size(), surface.points.size() - 2);
  EXPECT_GT(shortest_edge(joined->surface), 1.9);
  EXPECT_NEAR(joined->surface.volume(), surface.volume(), 0.5 * 0.03 * 2 * length + 1e-9);
  EXPECT_LE(distance_between(surface, joined->surface), 0.03 + 1e-9);
}

TEST(ShortFeatures, AStepThatIsHighEnoughStays) {
  EXPECT_FALSE(join_short_features(block_with_steps({2}, 0.06), sharp_from, shortest).has_value());
}

TEST(ShortFeatures, WhatGoesStepByStepStaysWithinTheLimit) {
  std::vector<double> places;
  for (int i = 1; i <= 12; ++i) places.push_back(0.02 * i);  // a slope of 24 steps up or down
  const Surface surface = block_with_steps(places, 0.02);
  const auto joined = join_short_features(surface, sharp_from, shortest);
  ASSERT_TRUE(joined.has_value());
  EXPECT_NO_THROW(check_surface(joined->surface));
  EXPECT_GE(joined->count, 16u);  // of 50 vertices
  EXPECT_LE(distance_between(surface, joined->surface), shortest);
}

// Its rim is a strip as narrow as a step, and without it both sides would meet there.
TEST(ShortFeatures, ThinPlatesAndFinsStay) {
  EXPECT_FALSE(join_short_features(surface_of(box({0, 0, 0}, {4, 4, 0.04})), sharp_from, shortest).has_value());
  const Surface fin = surface_of(testing::joined(box({0, 0, 0}, {4, 4, 4}), box({9, 0, 0}, {9.04, 4, 4})));
  EXPECT_FALSE(join_short_features(fin, sharp_from, shortest).has_value());
}

TEST(ShortFeatures, NamesStay) {
  Surface surface = block_with_steps({2}, 0.03);
  testing::tag_where(surface, 7, [](const Vec3& p) { return std::abs(p.x - 2) < 1e-9 && p.y > 2; });
  const auto has_tag = [](const Surface& s) { return std::ranges::count(s.tags, 7) > 0; };
  ASSERT_TRUE(has_tag(surface));
  const auto without_name = join_short_features(surface, sharp_from, shortest);
  ASSERT_TRUE(without_name.has_value());
  EXPECT_FALSE(has_tag(without_name->surface));
  surface.names.surfaces[7] = "inlet";
  const auto with_name = join_short_features(surface, sharp_from, shortest);
  EXPECT_TRUE(!with_name || has_tag(with_name->surface));
}

TEST(ShortFeatures, CurvesEndWhereTheirPointsWent) {
  Surface surface = block_with_steps({2}, 0.03);
  const auto point_at = [](const Surface& s, const Vec3& p) {
    return static_cast<Vertex>(std::ranges::find(s.points, p) - s.points.begin());
  };
  const Vertex low = point_at(surface, {2, 2, 0}), high = point_at(surface, {2, 2.03, 0});
  const Vertex right = point_at(surface, {length, 2, 0}), left = point_at(surface, {0, 2.03, 0});
  surface.curves = {{low, high}, {low, right}, {high, left}};
  surface.curve_tags = {1, 2, 3};
  const auto joined = join_short_features(surface, sharp_from, shortest);
  ASSERT_TRUE(joined.has_value());
  const Surface& made = joined->surface;
  EXPECT_EQ(made.curve_tags, (std::vector<std::int32_t>{2, 3}));
  ASSERT_EQ(made.curves.size(), 2u);
  EXPECT_EQ(made.curves[0][0], made.curves[1][0]);
  EXPECT_EQ(made.curves[0][1], point_at(made, {length, 2, 0}));
  EXPECT_EQ(made.curves[1][1], point_at(made, {0, 2.03, 0}));
}

}  // namespace
}  // namespace hexpipe
