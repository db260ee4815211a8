// Slivers that go, and holes that are named.

#include <gtest/gtest.h>

#include "tools/wrap/neighbourhood.hpp"
#include "tools/wrap/open_sheets.hpp"
#include "tools/wrap/restoring_steps.hpp"
#include "tools/wrap/shrink_wrap.hpp"

namespace hexpipe::wrap {
namespace {

// The tetrahedron at the origin with legs of length 1.
Surface corner() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

double volume_of(const Surface& surface) {
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles)
    volume += det(surface.points[a], surface.points[b], surface.points[c]) / 6;
  return volume;
}

// A point at `place` splits a triangle into three.
void split(Surface& surface, std::size_t t, const Vec3& place) {
  const auto [a, b, c] = surface.triangles[t];
  const auto s = static_cast<Vertex>(surface.points.size());
  surface.points.push_back(place);
  surface.triangles[t] = {a, b, s};
  surface.triangles.push_back({b, c, s});
  surface.triangles.push_back({c, a, s});
}

TEST(Slivers, FlipOrMergeWhereTheShapeStays) {
  for (const Vec3& place : {Vec3{0.5, 0, 0}, Vec3{1e-9, 0.3, 0}, Vec3{0.5, 1e-7, 0}, Vec3{0.999, 0, 0}}) {
    Surface surface = corner();
    const TriangleTree tree(surface);
    split(surface, 0, place);
    EXPECT_EQ(remove_slivers(surface, tree, {0.01, 0.001}), 0U);
    EXPECT_NEAR(volume_of(surface), 1.0 / 6, 1e-6);
    EXPECT_TRUE(crossing_triangles(surface).empty());
    EXPECT_FALSE(widest_hole(surface));
  }
}

TEST(Slivers, TwoOnEachOtherGoTogether) {
  // Both neighbours of the edge 0..1 get a point almost on it.
  Surface surface = corner();
  const TriangleTree tree(surface);
  split(surface, 0, {0.4, 1e-6, 0});
  split(surface, 1, {0.6, 0, 1e-6});
  EXPECT_EQ(remove_slivers(surface, tree, {0.01, 0.001}), 0U);
  EXPECT_NEAR(volume_of(surface), 1.0 / 6, 1e-5);
}

TEST(Slivers, StayWhereTheyAreTheShape) {
  // A needle: nothing can be merged without loss.
  Surface needle{{{0, 0, 0}, {1, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}}, corner().triangles};
  const TriangleTree tree(needle);
  EXPECT_GT(remove_slivers(needle, tree, {1e-3, 1e-4}), 0U);
  EXPECT_EQ(needle.triangles.size(), 4U);
}

TEST(Neighbourhood, PointsMergeOnlyWhereTheSurfaceStaysASurface) {
  Surface surface = corner();
  EXPECT_FALSE(may_merge(surface, triangles_around(surface), 0, 1));
  split(surface, 0, {0.2, 0.2, 0});
  EXPECT_TRUE(may_merge(surface, triangles_around(surface), 4, 1));
}

TEST(OpenSheets, TheWidestHoleHasAPlaceAndAWidth) {
  Surface open = corner();
  EXPECT_FALSE(widest_hole(open));
  open.triangles.pop_back();
  const auto hole = widest_hole(open);
  ASSERT_TRUE(hole);
  EXPECT_EQ(hole->edges, 3U);
  EXPECT_NEAR(norm(hole->middle - Vec3{1.0 / 3, 1.0 / 3, 1.0 / 3}), 0, 1e-12);
  // An equilateral triangle with sides of the root of 2: 4 sqrt(3)/2 / (3 sqrt(2)).
  EXPECT_NEAR(hole->width, 0.8164965809, 1e-9);
  // A triangle in the air is no hole.
  const Surface one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_FALSE(widest_hole(one));
}

TEST(OpenSheets, AWrapOfASheetIsDoubledAndThatOfABodyIsNot) {
  const Surface body = corner(), sheet{body.points, {body.triangles[0]}};
  EXPECT_LT(find_sheets(shrink_wrap(body, 0.1, 0.01), TriangleTree(body), 4, 0.01).share, 0.02);
  const Sheets sheets = find_sheets(shrink_wrap(sheet, 0.1, 0.01), TriangleTree(sheet), 1, 0.01);
  EXPECT_GT(sheets.share, 0.8);
  EXPECT_TRUE(sheets.is_sheet[0]);
}

}  // namespace
}  // namespace hexpipe::wrap
