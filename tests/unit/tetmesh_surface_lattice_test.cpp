#include "tools/tetmesh/surface/surface_lattice.hpp"

#include <gtest/gtest.h>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/fields/layers_across.hpp"
#include "tools/tetmesh/surface/feature_curves.hpp"
#include "tools/tetmesh/surface/feature_paths.hpp"
#include "tools/tetmesh/surface/links_across.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe {
using namespace tetmesh::fields;
using namespace tetmesh::geometry;
using namespace tetmesh::solid;
using namespace tetmesh::surface;
namespace {

using testing::box;
using testing::Facets;
using testing::prism;
using testing::sphere;
using testing::surface_of;

// As a surface is remeshed: features sampled, triangles refined.
struct Prepared {
  Prepared(const Facets& facets, double size) : Prepared(surface_of(facets), size, false) {}
  // With or without what faces what.
  Prepared(const Surface& whole, double size, bool knows_sides) : Prepared(mesh_of(whole, size), size, knows_sides) {}

  std::vector<Vertex> kept;
  FieldSurface surface;
  std::vector<OppositeSide> opposite;
  CrossField field;
  std::vector<SurfacePoint> points;

 private:
  Prepared(const FeatureMesh& mesh, double size, bool knows_sides)
      : kept(kept_of(mesh)),
        surface(mesh, size),
        opposite(knows_sides ? opposite_sides(surface) : std::vector<OppositeSide>()),
        field(cross_field(surface, opposite)),
        points(surface_lattice({surface, field, opposite, kept}, kept, {}, {}).points) {}

  static FeatureMesh mesh_of(const Surface& whole, double size) {
    FeatureMesh mesh(whole, 40);
    sample_feature_curves(mesh, size, 0.1 * size);
    refine_surface(mesh, size, 1e-6);
    return mesh;
  }
  static std::vector<Vertex> kept_of(const FeatureMesh& mesh) {
    std::vector<Vertex> kept;
    for (const auto v : mesh.vertices())
      if (mesh.is_kept(v)) kept.push_back(v.idx());
    return kept;
  }
};

double from_whole(double x) {
  return std::abs(x - std::round(x));
}

TEST(SurfaceLattice, OfABoxIsItsGrid) {
  const Prepared prepared(box({0, 0, 0}, {3, 4, 5}), 1);
  ASSERT_FALSE(prepared.points.empty());
  for (const SurfacePoint& p : prepared.points)
    for (int axis = 0; axis < 3; ++axis) EXPECT_LT(from_whole(p.position[axis]), 1e-6);
  const auto has = [&](const Vec3& place) {
    return std::ranges::any_of(prepared.points, [&](const SurfacePoint& p) { return norm(p.position - place) < 1e-6; });
  };
  for (int x = 1; x < 3; ++x)
    for (int y = 1; y < 4; ++y) EXPECT_TRUE(has({double(x), double(y), 0}) && has({double(x), double(y), 5}));
}

TEST(SurfaceLattice, SpreadsWhatDoesNotFit) {
  // Six steps of 1.07 along x: the rows that three from either side lead to lie in the middle.
  const Prepared prepared(box({0, 0, 0}, {6.42, 4, 5}), 1);
  std::size_t in_rows = 0, on_top = 0;
  for (std::size_t i = 0; i < prepared.points.size() / 2; ++i) {  // the more trusted ones
    const SurfacePoint& p = prepared.points[i];
    if (prepared.surface.normals[p.triangle].z < 0.5) continue;
    ++on_top;
    in_rows += 1.07 * from_whole(p.position.x / 1.07) < 0.12;
  }
  EXPECT_GT(on_top, 10u);
  EXPECT_EQ(in_rows, on_top);
}

// 3.6 sizes lie between the sides of a block and a square in the middle of its top.
TEST(SurfaceLattice, WholeNumbersOfRowsBetweenFeaturesDoNotEnd) {
  constexpr double width = 12.9, height = 6, margin = width * 5 / 18;
  Surface block = surface_of(box({0, 0, 0}, {width, width, height}, 18));
  const auto is_middle = [](double x) { return x > margin && x < width - margin; };
  testing::tag_where(block, 2, [&](const Vec3& c) { return c.z > height - 0.1 && is_middle(c.x) && is_middle(c.y); });
  const Prepared prepared(block, 1, false);
  const auto row_ends = [&](bool are_whole) {
    const CorrectedLinks links(prepared.surface, prepared.field, {}, prepared.kept);
    return surface_lattice(links, prepared.kept, {.are_whole = are_whole}, {}).row_ends;
  };
  EXPECT_EQ(row_ends(true), 0);
  EXPECT_GT(row_ends(false), 0);
}

// A plate nine sizes wide whose tags meet along the middle of its top, half a size off the rows below.
double offset_below(double height, bool knows_sides) {
  Surface plate = surface_of(box({0, 0, 0}, {9, 9, height}, 18));
  testing::tag_where(plate, 2, [&](const Vec3& c) { return c.z > 0.97 * height && c.x > 4.5; });
  const Prepared prepared(plate, 1, knows_sides);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < prepared.points.size() / 2; ++i) {  // the more trusted ones
    const SurfacePoint& p = prepared.points[i];
    if (prepared.surface.normals[p.triangle].z > -0.5 || std::abs(p.position.x - 4.5) > 1) continue;
    sum += from_whole(p.position.x - 4.5);
    ++count;
  }
  EXPECT_GT(count, 10);
  return sum / count;
}

TEST(SurfaceLattice, RowsOfBothSidesOfAWallMeet) {
  EXPECT_GT(offset_below(2, false), 0.4);
  EXPECT_LT(offset_below(2, true), 0.15);
}

std::size_t count_of(const LinksAcross& across, const FieldSurface& surface, auto which) {
  std::size_t count = 0;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(surface.triangles.size()); ++f)
    if (which(f)) count += across.of(f).size();
  return count;
}

TEST(LinksAcross, LeadToWhatLiesBehind) {
  const Prepared plate(surface_of(box({0, 0, 0}, {6, 5, 2}, 6)), 1, true);
  const SurfaceLinks links(plate.surface, plate.field);
  const LinksAcross across(links, plate.opposite);
  const auto& surface = plate.surface;
  EXPECT_GT(count_of(across, surface, [&](std::int32_t f) { return std::abs(surface.normals[f].z) > 0.5; }), 60u);
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(surface.triangles.size()); ++f)
    for (const SurfaceLink& link : across.of(f)) {
      EXPECT_GT(link.weight, 0);
      EXPECT_LT(dot(surface.normals[f], surface.normals[link.neighbour]), -0.99);
      const auto axes = plate.field.axes(surface, f);
      const Vec3 back = surface.centres[f] - surface.centres[link.neighbour];
      for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(link.distance[k], dot(axes[k], back), 1e-6);
      const auto reversed = across.of(link.neighbour);
      EXPECT_TRUE(std::ranges::any_of(reversed, [&](const SurfaceLink& r) { return r.neighbour == f; }));
    }
}

TEST(LinksAcross, AreNoneWhereOneSideIsMuchLonger) {
  const Prepared bar(surface_of(prism(40, 3, 10)), 1, true);
  const SurfaceLinks links(bar.surface, bar.field);
  const LinksAcross across(links, bar.opposite);
  const auto is_round = [&](std::int32_t f) { return std::abs(bar.surface.normals[f].z) < 0.5; };
  EXPECT_EQ(count_of(across, bar.surface, is_round), 0u);
  EXPECT_GT(count_of(across, bar.surface, [&](std::int32_t f) { return !is_round(f); }), 20u);
}

TEST(LinksAcross, AreNoneWhereSizesDiffer) {
  Prepared plate(surface_of(box({0, 0, 0}, {6, 5, 3}, 6)), 1, true);
  for (std::size_t f = 0; f < plate.surface.sizes.size(); ++f)
    plate.surface.sizes[f] = std::min(1.0, 0.4 + 0.5 * plate.surface.centres[f].z);
  const SurfaceLinks links(plate.surface, plate.field);
  const LinksAcross across(links, plate.opposite);
  const auto is_flat = [&](std::int32_t f) { return std::abs(plate.surface.normals[f].z) > 0.5; };
  EXPECT_EQ(count_of(across, plate.surface, is_flat), 0u);
}

TEST(LayersAcross, AreThoseThatStretchLeast) {
  EXPECT_EQ(layers_across(0.6), 1);
  EXPECT_EQ(layers_across(1.41), 1);  // 1.41 sizes each, or 0.705
  EXPECT_EQ(layers_across(1.42), 2);
  EXPECT_EQ(layers_across(widest_to_decide), 2);
}

double sum_of(const SurfaceLinks& links, const NarrowStrip& strip) {
  double sum = 0;
  for (const auto& [number, backwards] : strip.across) {
    const double distance = links.of[number / 2].distance[static_cast<std::size_t>(number % 2)];
    sum += backwards ? -distance : distance;
  }
  return sum;
}

TEST(NarrowStrip, LeadsFromTheEdgesOfAPlateAcrossItsSides) {
  const double height = 1.6;
  const Prepared plate(surface_of(box({0, 0, 0}, {6, 5, height}, 6)), 1, true);
  const auto& surface = plate.surface;
  const SurfaceLinks links(surface, plate.field);
  std::size_t found = 0;
  for (HalfEdge h = 0; h < static_cast<HalfEdge>(surface.feature.size()); ++h) {
    if (!surface.feature[h]) continue;
    const bool is_on_side = std::abs(surface.normals[triangle_of(h)].z) < 0.5;
    const bool is_upright = std::abs(unit(surface.edge_vector(h)).z) > 0.5;
    const auto strip = narrow_strip(links, h, 1.75);
    ASSERT_EQ(strip.has_value(), is_on_side && !is_upright);
    if (!strip) continue;
    ++found;
    EXPECT_NEAR(strip->width, height, 1e-6);
    // Distances lead back from what lies further on.
    EXPECT_NEAR(strip->before + strip->after - sum_of(links, *strip), height, 1e-6);
    EXPECT_FALSE(narrow_strip(links, h, 1.5)) << "it is wider";
  }
  EXPECT_GE(found, 2 * 2 * (6u + 5u));
}

TEST(SurfaceLattice, PointsLieOnTheSurface) {
  const Prepared prepared(sphere({1, 2, 3}, 2, 12), 0.5);
  for (const SurfacePoint& p : prepared.points) {
    const Vec3& corner = prepared.surface.points[prepared.surface.triangles[p.triangle][0]];
    EXPECT_NEAR(dot(p.position - corner, prepared.surface.normals[p.triangle]), 0, 1e-9);
  }
}

TEST(SurfaceLattice, WalksStraightWhateverTheField) {
  const Prepared prepared(box({0, 0, 0}, {3, 4, 5}), 1);
  const FieldWalker walker(prepared.surface, prepared.field);
  const Vec3 way = Vec3{2, 1, 0} * (1 / std::sqrt(5.0));
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(prepared.surface.triangles.size()); ++f) {
    const auto [a, b, c] = prepared.surface.triangles[f];
    const auto& points = prepared.surface.points;
    const Vec3 start = (points[a] + points[b] + points[c]) * (1.0 / 3);
    if (prepared.surface.normals[f].z < 0.5 || start.x > 2 || start.y > 3) continue;
    const WalkEnd end = walker.walk_straight({start, f}, way, 1);
    EXPECT_FALSE(end.at_feature);
    EXPECT_LT(norm(end.point.position - start - way), 1e-9);
  }
}

}  // namespace
}  // namespace hexpipe
