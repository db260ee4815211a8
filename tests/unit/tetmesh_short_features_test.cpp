#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

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

// Triangles between two rows of points that go the same way, from their starts to their ends.
Facets strip_between(const std::vector<Vec3>& left, const std::vector<Vec3>& right) {
  Facets facets;
  for (std::size_t i = 0, k = 0; i + 1 < left.size() || k + 1 < right.size();) {
    const bool on_left = k + 1 == right.size() || (i + 1 < left.size() && left[i + 1].z <= right[k + 1].z);
    const Vec3 next = on_left ? left[i + 1] : right[k + 1];
    facets.push_back({left[i], next, right[k]});
    ++(on_left ? i : k);
  }
  return facets;
}

// The sides and the bottom of a block whose top begins at these points, from left to right.
Facets block_below(const std::vector<Vec3>& front) {
  const Vec3 along{0, 0, length}, corner{0, 0, 0}, right{front.back().x, 0, 0};
  Facets facets;
  for (std::size_t i = front.size(); i-- > 1;) {
    facets.push_back({corner, front[i - 1], front[i]});
    facets.push_back({corner + along, front[i] + along, front[i - 1] + along});
  }
  facets.push_back({corner, front.back(), right});
  facets.push_back({corner + along, right + along, front.back() + along});
  for (const auto& [p, q] :
       {std::pair{corner, right}, std::pair{right, front.back()}, std::pair{front.front(), corner}}) {
    facets.push_back({p, q, q + along});
    facets.push_back({p, q + along, p + along});
  }
  return facets;
}

constexpr double strip_width = 0.02;
constexpr std::int32_t strip_tag = 7;

// A block with a strip along its top, whose sides have points that do not face each other.
Surface block_with_a_strip() {
  const auto row = [](double x, const std::vector<double>& places) {
    std::vector<Vec3> points;
    for (const double z : places) points.push_back({x, 2, z});
    return points;
  };
  const std::vector<std::vector<Vec3>> rows{row(0, {0, length}), row(2, {0, 1.3, 2.6, length}),
                                            row(2 + strip_width, {0, 0.7, 2, 3.1, length}), row(length, {0, length})};
  Facets facets;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i)
    facets = testing::joined(facets, strip_between(rows[i], rows[i + 1]));
  std::vector<Vec3> front;
  for (const std::vector<Vec3>& row : rows) front.push_back(row.front());
  facets = testing::joined(facets, block_below(front));
  Surface surface = surface_of(facets);
  testing::tag_where(surface, strip_tag, [](const Vec3& p) { return p.y == 2 && p.x > 2 && p.x < 2 + strip_width; });
  for (const double x : {2.0, 2 + strip_width})
    for (const Triangle& t : surface.triangles)
      for (int i = 0; i < 3; ++i) {
        const Vertex a = t[i], b = t[(i + 1) % 3];
        const Vec3 &p = surface.points[a], &q = surface.points[b];
        if (a > b || p.x != x || q.x != x) continue;
        surface.curves.push_back({a, b});
        surface.curve_tags.push_back(x == 2 ? 1 : 2);
      }
  return surface;
}

double least_height(const Surface& surface) {
  double least = std::numeric_limits<double>::max();
  for (const Triangle& t : surface.triangles) {
    const auto at = [&](int i) { return surface.points[t[i % 3]]; };
    for (int i = 0; i < 3; ++i)
      least = std::min(least, norm(cross(at(i + 1) - at(i), at(i + 2) - at(i))) / norm(at(i + 1) - at(i)));
  }
  return least;
}

TEST(ShortFeatures, AStripGoesWhosePointsDoNotFaceEachOther) {
  const Surface surface = block_with_a_strip();
  EXPECT_NO_THROW(check_surface(surface));
  ASSERT_EQ(surface.curves.size(), 7u);
  const auto joined = join_short_features(surface, sharp_from, shortest);
  ASSERT_TRUE(joined.has_value());
  const Surface& made = joined->surface;
  EXPECT_NO_THROW(check_surface(made));
  EXPECT_EQ(joined->count, 7u);  // two at the ends go, the five in between join
  EXPECT_EQ(made.points.size(), surface.points.size() - 2);
  EXPECT_EQ(std::ranges::count(made.tags, strip_tag), 0);
  EXPECT_GT(least_height(made), 0.2);
  EXPECT_NEAR(made.volume(), surface.volume(), 0.5 * strip_width * 2 * length);
  EXPECT_LE(distance_between(surface, made), strip_width);
  // The one curve of both goes by all of them, along edges.
  ASSERT_EQ(made.curves.size(), 6u);
  for (const auto& [a, b] : made.curves)
    EXPECT_TRUE(std::ranges::any_of(
        made.triangles, [&](const Triangle& t) { return std::ranges::count(t, a) + std::ranges::count(t, b) == 2; }));
}

TEST(ShortFeatures, AStripWithANameKeepsATriangle) {
  Surface surface = block_with_a_strip();
  surface.names.surfaces[strip_tag] = "seal";
  const auto joined = join_short_features(surface, sharp_from, shortest);
  ASSERT_TRUE(joined.has_value());
  EXPECT_NO_THROW(check_surface(joined->surface));
  EXPECT_GE(std::ranges::count(joined->surface.tags, strip_tag), 1);
}

// The curve leaves the edge slowly, and is further from it than the limit in its middle.
TEST(ShortFeatures, WhatJoinsPointByPointStaysWithinTheLimit) {
  std::vector<Vec3> arc, back{{0, 2, 0}, {0, 2, length}};
  for (int i = 0; i <= 16; ++i) {
    const double z = length * i / 16;
    arc.push_back({1 + 0.02 * z * (length - z), 2, z});  // 0.08 wide
  }
  const std::vector<Vec3> edge{{1, 2, 0}, {1, 2, length}};
  Facets facets = strip_between(back, edge);
  // The lens between the edge and the arc is a fan.
  for (std::size_t i = 1; i + 1 < arc.size(); ++i) facets.push_back({arc[0], arc[i + 1], arc[i]});
  facets = testing::joined(facets, strip_between(arc, {{2, 2, 0}, {2, 2, length}}));
  facets = testing::joined(facets, block_below({back[0], edge[0], {2, 2, 0}}));
  Surface surface = surface_of(facets);
  testing::tag_where(surface, strip_tag,
                     [](const Vec3& p) { return p.y == 2 && p.x > 1 && p.x < 1 + 0.02 * p.z * (length - p.z); });
  ASSERT_EQ(std::ranges::count(surface.tags, strip_tag), 15);
  const auto joined = join_short_features(surface, sharp_from, shortest);
  ASSERT_TRUE(joined.has_value());
  EXPECT_NO_THROW(check_surface(joined->surface));
  EXPECT_LE(distance_between(surface, joined->surface), shortest);
  const auto left = std::ranges::count(joined->surface.tags, strip_tag);
  EXPECT_GT(left, 0);
  EXPECT_LT(left, 15);
  double area = 0;
  for (std::size_t t = 0; t < joined->surface.triangles.size(); ++t) {
    if (joined->surface.tags[t] != strip_tag) continue;
    const auto& [a, b, c] = joined->surface.triangles[t];
    const auto& points = joined->surface.points;
    area += norm(cross(points[b] - points[a], points[c] - points[a])) / 2;
  }
  // Nothing in its middle went: there it is too wide.
  EXPECT_GT(area, 0.5 * (0.02 * length * length * length / 6));
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
