#include "tools/tetmesh/surface/cross_field.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/surface/feature_curves.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"
#include "tools/tetmesh/surface/opposite_sides.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::solid;
using namespace tetmesh::surface;
namespace {

using testing::box;
using testing::Facets;
using testing::prism;
using testing::soup_of;
using testing::sphere;
using testing::surface_of;

FeatureMesh refined(const Facets& facets, double longest) {
  FeatureMesh mesh(surface_of(facets), 40);
  refine_surface(mesh, longest, 1e-6);
  return mesh;
}

// Least over the triangles of |cos| to one of the cross's arms, 1 / sqrt(2) being the worst.
double worst_alignment(const FieldSurface& surface, const CrossField& field, auto wanted) {
  double worst = 1;
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    const std::optional<Vec3> direction = wanted(surface, f);
    if (!direction) continue;
    const Vec3 x = field.directions[f], y = cross(surface.normals[f], x);
    worst = std::min(worst, std::max(std::abs(dot(*direction, x)), std::abs(dot(*direction, y))));
  }
  return worst;
}

TEST(CrossField, IsUnitAndTangent) {
  const FieldSurface surface(refined(sphere({1, 2, 3}, 2, 12), 0.5), 0.5);
  const CrossField field = cross_field(surface);
  ASSERT_EQ(field.directions.size(), surface.triangles.size());
  for (std::size_t f = 0; f < field.directions.size(); ++f) {
    EXPECT_NEAR(norm(field.directions[f]), 1, 1e-12);
    EXPECT_NEAR(dot(field.directions[f], surface.normals[f]), 0, 1e-12);
  }
}

TEST(CrossField, RunsAlongTheEdgesOfABox) {
  const FieldSurface surface(refined(box({0, 0, 0}, {3, 2, 1}), 0.3), 0.3);
  const CrossField field = cross_field(surface);
  const double worst = worst_alignment(surface, field, [](const FieldSurface& s, std::size_t f) -> std::optional<Vec3> {
    return std::abs(s.normals[f].z) > 0.5 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
  });
  EXPECT_GT(worst, 1 - 1e-6);
}

TEST(CrossField, FollowsTheBendOfATube) {
  // No triangle of the sides is as wide as the size: the curvature has to be found over several.
  const FieldSurface surface(refined(prism(40, 1, 8), 0.3), 0.3);
  const CrossField field = cross_field(surface);
  const double worst = worst_alignment(surface, field, [](const FieldSurface& s, std::size_t f) -> std::optional<Vec3> {
    if (std::abs(s.normals[f].z) > 0.5) return std::nullopt;
    return Vec3{0, 0, 1};
  });
  EXPECT_GT(worst, 0.999);
}

// A box with a line of features across its top from corner to corner, where tags meet.
FeatureMesh with_diagonal(double height) {
  Surface surface = surface_of(box({0, 0, 0}, {9, 9, height}, 9));
  testing::tag_where(surface, 2, [&](const Vec3& c) { return c.z > 0.97 * height && c.x > c.y; });
  FeatureMesh mesh(surface, 40);
  refine_surface(mesh, 0.7, 1e-6);
  return mesh;
}

// How well the field in the middle of the bottom lies along the diagonal.
double alignment_below(const FeatureMesh& mesh) {
  const FieldSurface surface(mesh, 0.5);
  return worst_alignment(
      surface, cross_field(surface, opposite_sides(surface)), [](const FieldSurface& s, std::size_t f) {
        const Vec3& c = s.centres[f];
        const bool in_the_middle = s.normals[f].z < -0.5 && norm(c - Vec3{4.5, 4.5, 0}) < 0.8;
        return in_the_middle ? std::optional(Vec3{std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2, 0}) : std::nullopt;
      });
}

TEST(CrossField, FollowsWhatIsOnTheOtherSideOfAWall) {
  EXPECT_GT(alignment_below(with_diagonal(1)), 0.95);
  EXPECT_LT(alignment_below(with_diagonal(20)), 0.75) << "too far away, and the sides say otherwise";
}

std::vector<OppositeSide> sides_by_triangle(const FieldSurface& surface) {
  std::vector<OppositeSide> sides(surface.triangles.size());
  for (const OppositeSide& side : opposite_sides(surface)) sides[side.from] = side;
  return sides;
}

TEST(OppositeSides, AreThoseOfABox) {
  const FieldSurface surface(refined(box({0, 0, 0}, {3, 2, 1}), 0.3), 0.1);
  const auto sides = sides_by_triangle(surface);
  ASSERT_EQ(sides.size(), surface.triangles.size());
  for (std::size_t f = 0; f < sides.size(); ++f) {
    const Vec3& n = surface.normals[f];
    const double across = std::abs(n.x) > 0.5 ? 3 : std::abs(n.y) > 0.5 ? 2 : 1;
    if (across > 2.5) {
      EXPECT_EQ(sides[f].triangle, -1) << "30 sizes away";
      continue;
    }
    ASSERT_GE(sides[f].triangle, 0);
    EXPECT_NEAR(sides[f].distance, across / 0.1, 1e-9);
    EXPECT_NEAR(dot(surface.normals[sides[f].triangle], n), -1, 1e-9);
  }
}

TEST(OppositeSides, AreParallel) {
  Facets wedge = box({0, 0, 0}, {4, 4, 1}, 4);
  for (auto& facet : wedge)
    for (Vec3& p : facet) p.z *= 0.2 + p.x / 4;
  const FieldSurface surface(refined(wedge, 0.3), 0.1);
  const auto sides = sides_by_triangle(surface);
  for (std::size_t f = 0; f < sides.size(); ++f) {
    if (surface.normals[f].z < -0.5) {
      ASSERT_GE(sides[f].triangle, 0) << "14 degrees";
    }
  }
  for (auto& facet : wedge)
    for (Vec3& p : facet) p.z *= 3;
  const FieldSurface steep(refined(wedge, 0.3), 0.1);
  const auto beyond = sides_by_triangle(steep);
  for (std::size_t f = 0; f < beyond.size(); ++f) {
    if (steep.normals[f].z < -0.5) {
      EXPECT_EQ(beyond[f].triangle, -1) << "37 degrees";
    }
  }
}

TEST(FieldWalk, GoesStraightToTheEdgeOfABox) {
  const FieldSurface surface(refined(box({0, 0, 0}, {3, 2, 1}), 0.3), 0.3);
  const CrossField field = cross_field(surface);
  const FieldWalker walker(surface, field);
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(surface.triangles.size()); ++f) {
    if (surface.normals[f].z < 0.5) continue;
    const auto [a, b, c] = surface.triangles[f];
    const SurfacePoint start{(surface.points[a] + surface.points[b] + surface.points[c]) * (1.0 / 3), f};
    const WalkEnd edge = walker.walk(start, walker.nearest_direction(f, {1, 0, 0}), 100);
    EXPECT_TRUE(edge.at_feature);
    EXPECT_NEAR(edge.point.position.x, 3, 1e-6);
    EXPECT_NEAR(edge.length, 3 - start.position.x, 1e-6);
    const double part = 0.4 * edge.length;
    const WalkEnd inside = walker.walk(start, walker.nearest_direction(f, {1, 0, 0}), part);
    EXPECT_FALSE(inside.at_feature);
    EXPECT_NEAR(norm(inside.point.position - start.position), part, 1e-6);
  }
}

TEST(FeatureCurves, OfABoxAreItsEdgesInWholeSteps) {
  FeatureMesh mesh(surface_of(box({0, 0, 0}, {3, 2, 1}, 2)), 40);
  const auto curves = feature_curves(mesh);
  EXPECT_EQ(curves.size(), 12u);
  for (const FeatureCurve& curve : curves) EXPECT_FALSE(curve.closed);
  sample_feature_curves(mesh, 0.3, 0.01);
  std::size_t kept = 0;
  for (const auto v : mesh.vertices()) kept += mesh.is_kept(v);
  EXPECT_EQ(kept, 8u + 4 * (9 + 6 + 2));  // 10, 7 and 3 steps
}

TEST(FeatureCurves, RimsOfATubeStartAtOneAngle) {
  FeatureMesh mesh(surface_of(prism(60, 1, 5)), 40);
  const auto curves = feature_curves(mesh);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_TRUE(curves[0].closed && curves[1].closed);
  sample_feature_curves(mesh, 0.37, 0.2);
  std::vector<Vec3> rims[2];
  for (const auto v : mesh.vertices())
    if (mesh.is_kept(v)) rims[mesh.position(v).z > 2].push_back(mesh.position(v));
  EXPECT_EQ(rims[0].size(), 16u);  // 17 steps, made even
  ASSERT_EQ(rims[1].size(), rims[0].size());
  for (const Vec3& p : rims[0])
    EXPECT_EQ(std::ranges::count_if(rims[1], [&](const Vec3& q) { return norm(q - p - Vec3{0, 0, 5}) < 1e-9; }), 1);
}

TEST(FeatureCurves, BendByTheDeviationAtMost) {
  for (const double deviation : {0.2, 0.01}) {
    FeatureMesh mesh(surface_of(prism(100, 1, 5)), 40);
    sample_feature_curves(mesh, 1, deviation);
    std::size_t kept = 0;
    for (const auto v : mesh.vertices()) kept += mesh.is_kept(v);
    EXPECT_EQ(kept / 2, deviation == 0.2 ? 6u : 24u) << deviation;  // 1 - cos(pi / n) is the sagitta
  }
}

TEST(FeatureCurves, TagsMakeThem) {
  SurfaceSoup soup = soup_of(box({0, 0, 0}, {1, 1, 1}, 4));
  for (std::size_t i = 0; i < soup.triangles.size(); ++i)
    soup.tags[i] = soup.points[soup.triangles[i][0]].x + soup.points[soup.triangles[i][1]].x +
                       soup.points[soup.triangles[i][2]].x <
                   1.5;
  const FeatureMesh mesh(find_shells(soup, ShellRule::oriented), 100);
  const auto curves = feature_curves(mesh);
  ASSERT_EQ(curves.size(), 1u);  // around the middle; at 100 degrees the box's own edges are none
  for (const auto v : curves[0].vertices) EXPECT_NEAR(mesh.position(v).x, 0.5, 1e-12);
}

}  // namespace
}  // namespace hexpipe
