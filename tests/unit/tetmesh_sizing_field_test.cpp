#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/run/random.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/sizing/sizing.hpp"

namespace hexpipe {
using namespace tetmesh::geometry;
using namespace tetmesh::sizing;
using namespace tetmesh::solid;
namespace {

using testing::cube;
using testing::surface_of;

Vec3 random_point(Random& random, double reach = 1) {
  const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
  return {x, y, random.uniform(-reach, reach)};
}

// Simplices of 1 to 4 corners with sizes from 0.1 to 1.
SizeSources random_sources(std::uint64_t seed, int count) {
  Random random(seed);
  SizeSources sources;
  for (int i = 0; i < count; ++i) {
    std::array<Vertex, 4> simplex{no_index, no_index, no_index, no_index};
    const Vec3 place = random_point(random, 4);
    for (int k = 0; k <= i % 4; ++k) {
      simplex[static_cast<std::size_t>(k)] = static_cast<Vertex>(sources.points.size());
      sources.points.push_back(place + random_point(random));
      sources.sizes.push_back(random.uniform(0.1, 1));
    }
    sources.simplices.push_back(simplex);
  }
  return sources;
}

// By samples of every simplex; too large by what lies between the samples.
double sampled(const SizeSources& sources, const Vec3& p, double greatest, double grading) {
  constexpr int n = 12;
  double least = greatest;
  for (const auto& simplex : sources.simplices)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        for (int k = 0; i + j + k <= n; ++k) {
          const std::array<int, 4> weights{n - i - j - k, i, j, k};
          Vec3 y;
          double size = 0;
          bool is_there = true;
          for (std::size_t c = 0; c < 4; ++c) {
            if (weights[c] == 0) continue;
            is_there = is_there && simplex[c] != no_index;
            if (!is_there) break;
            y += (1.0 / n * weights[c]) * sources.points[simplex[c]];
            size += 1.0 / n * weights[c] * sources.sizes[simplex[c]];
          }
          if (is_there) least = std::min(least, size + grading * norm(p - y));
        }
  return least;
}

TEST(SizeField, IsALengthWhereNothingElseIsKnown) {
  const SizeField field = 0.25;
  EXPECT_TRUE(field.is_uniform());
  EXPECT_EQ(field.at({1, 2, 3}), 0.25);
  EXPECT_EQ((4 * field).at({1, 2, 3}), 1);
  EXPECT_EQ((4 * field).least_near(1, 9), 1);
  EXPECT_TRUE(SizeField(random_sources(1, 8), 0.05, 0.3).is_uniform());
}

TEST(SizeField, IsTheGreatestThatGrowsNoFaster) {
  for (const double grading : {0.1, 0.4, 2.0}) {
    const SizeSources sources = random_sources(7, 24);
    const SizeField field(sources, 0.9, grading);
    Random random(3);
    for (int i = 0; i < 60; ++i) {
      const Vec3 p = random_point(random, 5);
      const double expected = sampled(sources, p, 0.9, grading);
      EXPECT_LE(field.at(p), expected + 1e-12);
      EXPECT_GE(field.at(p), expected - (grading + 1) * 0.15);
      const Vec3 q = p + random_point(random, 0.3);
      EXPECT_LE(std::abs(field.at(p) - field.at(q)), grading * norm(p - q) + 1e-12);
      EXPECT_GE(field.at(q), field.least_near(field.at(p), norm(p - q)) - 1e-12);
      for (const double length : {0.0, field.least(), random.uniform(0, 1), field.at(p), field.greatest(), 2.0})
        EXPECT_EQ(field.is_at_least(length, p), length <= field.at(p));
    }
  }
}

TEST(SizeField, IsLinearWhereSizesChangeSlowly) {
  SizeSources sources;
  sources.points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
  sources.sizes = {1, 1.2, 1.4, 1.1};
  sources.simplices = {{0, 1, 2, 3}};
  const SizeField field(sources, 10, 0.5);
  EXPECT_NEAR(field.at({0.4, 0.5, 0.6}), 1 + 0.1 * 0.4 + 0.2 * 0.5 + 0.05 * 0.6, 1e-12);
  EXPECT_NEAR(field.at({-1, -1, -1}), 1 + 0.5 * std::sqrt(3), 1e-12);  // from a corner
  EXPECT_EQ(field.at({100, 0, 0}), 10);
  EXPECT_EQ(field.least(), 1);
  EXPECT_EQ((2 * field).greatest(), 20);
}

// A prism is three tets, each with the size at all corners.
TEST(SizeField, IsTheSameInPrismsAndInTheirTets) {
  Random random(11);
  SizeSources prisms, tets;
  for (int i = 0; i < 12; ++i) {
    const Vec3 place = random_point(random, 4);
    const std::array<Vec3, 3> corners{place, place + random_point(random), place + random_point(random)};
    const Vec3 across = random.uniform(-2, 2) * unit(cross(corners[1] - corners[0], corners[2] - corners[0]));
    const double size = random.uniform(0.1, 0.8);
    prisms.prisms.push_back({corners, across, size});
    const auto first = static_cast<Vertex>(tets.points.size());
    for (const Vec3& p : corners) tets.points.push_back(p);
    for (const Vec3& p : corners) tets.points.push_back(p + across);
    tets.sizes.resize(tets.points.size(), size);
    for (Vertex k = first; k < first + 3; ++k) tets.simplices.push_back({k, k + 1, k + 2, k + 3});
  }
  const SizeField of_prisms(prisms, 0.9, 0.4), of_tets(tets, 0.9, 0.4);
  EXPECT_EQ(of_prisms.least(), of_tets.least());
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random_point(random, 5);
    EXPECT_NEAR(of_prisms.at(p), of_tets.at(p), 1e-9);
  }
}

TEST(SizeField, TakesFlatSimplicesForTheirCorners) {
  SizeSources sources;
  sources.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}};
  sources.sizes = {1, 1, 1, 0.5};
  sources.simplices = {{0, 1, 2, 3}};
  const SizeField field(sources, 10, 1);
  EXPECT_NEAR(field.at({1, 0, 0}), 0.5, 1e-12);
  EXPECT_NEAR(field.at({1, 3, 0}), 3.5, 1e-12);
}

TEST(BoxTree, FindsTheFirstHitOfARay) {
  Random random(5);
  std::vector<Box> boxes;
  for (int i = 0; i < 200; ++i) {
    const Vec3 low = random_point(random, 5);
    boxes.push_back({low, low + Vec3{0.3, 0.4, 0.5}});
  }
  const BoxTree tree(boxes, std::vector<double>(boxes.size(), 0.0));
  for (int i = 0; i < 100; ++i) {
    const Vec3 from = random_point(random, 5), direction = i % 3 == 0 ? Vec3{0, 1, 0} : random_point(random);
    const Vec3 inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
    const auto entry = [&](std::size_t k) { return boxes[k].entry(from, inverse); };
    double least = 100;
    for (std::size_t k = 0; k < boxes.size(); ++k) least = std::min(least, entry(k));
    EXPECT_EQ(tree.first_hit(from, direction, 100, [&](std::int32_t k) { return entry(static_cast<std::size_t>(k)); }),
              least);
  }
}

TEST(BoxTree, MeetingsHaveEachPairOfThingsWhoseBoxesMeetOnce) {
  Random random(7);
  for (const int count : {0, 1, 2, 3, 5, 77, 500}) {
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i) {
      const Vec3 low = random_point(random, 2);
      boxes.push_back({low, low + Vec3{random.uniform(0, 1), random.uniform(0, 1), i % 5 == 0 ? 4.0 : 0.2}});
    }
    const BoxTree tree(boxes, std::vector<double>(boxes.size(), 0.0));
    std::vector<std::pair<std::int32_t, std::int32_t>> expected;
    for (std::int32_t i = 0; i < count; ++i)
      for (std::int32_t j = i + 1; j < count; ++j)
        if (boxes[static_cast<std::size_t>(i)].meets(boxes[static_cast<std::size_t>(j)])) expected.emplace_back(i, j);
    for (const std::size_t most : {1u, 16u, 1000u}) {
      std::vector<std::pair<std::int32_t, std::int32_t>> found;
      for (const BoxTree::Meeting& meeting : tree.meetings(most))
        tree.for_each_near_pair(meeting, [&](std::int32_t i, std::int32_t j) {
          if (boxes[static_cast<std::size_t>(i)].meets(boxes[static_cast<std::size_t>(j)]))
            found.emplace_back(std::min(i, j), std::max(i, j));
        });
      std::ranges::sort(found);
      EXPECT_EQ(found, expected) << count << " things, " << most;
    }
  }
}

TEST(SizedPointGrid, FindsAllNear) {
  Random random(11);
  SizedPointGrid grid(Vec3{-5, -5, -5});
  std::vector<double> lengths;
  for (int i = 0; i < 500; ++i) {
    lengths.push_back(std::exp(random.uniform(-4, 0)));
    EXPECT_EQ(grid.add(random_point(random, 2), lengths.back()), i);
  }
  for (int i = 0; i < 50; ++i) {
    const Vec3 p = random_point(random, 2);
    const double reach = random.uniform(0.05, 0.6);
    std::vector<bool> seen(500);
    grid.for_each_near(p, reach, 0.1, [&](std::int32_t k) { return seen[static_cast<std::size_t>(k)] = true; });
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const Vec3 d = grid.points()[k] - p;
      const bool is_near = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) <= reach;
      EXPECT_TRUE(seen[k] || !is_near || lengths[k] < 0.1);
    }
  }
}

// In cells as wide as that all would be in a few.
TEST(SizedPointGrid, FindsFewWhereLengthsAreNothingBesideTheBox) {
  Random random(7);
  SizedPointGrid grid(Box{{-1, -1, -1}, {1, 1, 1}});
  std::vector<Vec3> points;
  for (int i = 0; i < 2000; ++i) points.push_back(random_point(random));
  for (const Vec3& p : points) grid.add(p, 1e-30);
  std::size_t visited = 0, found = 0;
  for (const Vec3& p : points)
    grid.for_each_near(p, 1e-30, 0, [&](std::int32_t i) {
      ++visited;
      found += points[static_cast<std::size_t>(i)] == p;
      return true;
    });
  EXPECT_EQ(found, points.size());
  EXPECT_LT(visited, 2 * points.size());
}

TEST(Sizing, CountsPointsOnASurfaceOfManySizes) {
  const Surface surface = surface_of(cube(0, 4));
  EXPECT_NEAR(points_on_surface(surface, 0.1, 1e9), 6 * 1600, 1e-6);
  SizeSources sources;
  sources.points = {{0, 0, 0}};
  sources.sizes = {0.02};
  sources.simplices = {{0, no_index, no_index, no_index}};
  const double many = points_on_surface(surface, SizeField(sources, 1, 0.2), 1e9);
  // Around the corner, three quarter circles: of r dr over (0.02 + 0.2 r) squared, and the rest of the size of 0.82 and
  // more.
  EXPECT_NEAR(many, 3 * std::numbers::pi / 2 * (std::log(1 + 0.2 * 4 / 0.02) - 1 + 0.02 / 0.82) / 0.04, 0.2 * many);
  EXPECT_LT(points_on_surface(surface, 1e-3, 100), 1e9);
}

}  // namespace
}  // namespace hexpipe
