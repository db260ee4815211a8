#include "tools/tetmesh/surface/curve_rows.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"
#include "tools/tetmesh/surface/surface_curl.hpp"
#include "tools/tetmesh/surface/surface_lattice.hpp"

namespace hexpipe {
using namespace tetmesh::surface;
namespace {

using testing::box;
using testing::Facets;
using testing::ring;
using testing::sphere;
using testing::surface_of;

FeatureMesh feature_mesh_of(const Facets& facets) {
  return {surface_of(facets), 40};
}

std::vector<MeasuredCurve> curves_of(const FeatureMesh& mesh, double size) {
  return curves_by_rows(mesh, size, 0.05 * size, 1.3 * size, 1e-5 * size);
}

// A box whose sides lean inwards: its top is `part` as long along x as its bottom.
Facets trapezoid(double part) {
  Facets facets = box({-6, -3, 0}, {6, 3, 4}, 6);
  for (auto& facet : facets)
    for (Vec3& p : facet) p.x *= 1 - (1 - part) * p.z / 4;
  return facets;
}

TEST(CurveRows, OfABoxAreOfTheSize) {
  const FeatureMesh mesh = feature_mesh_of(box({0, 0, 0}, {6, 4, 5}, 2));
  const auto curves = curves_of(mesh, 0.5);
  EXPECT_EQ(curves.size(), 12u);
  for (const MeasuredCurve& curve : curves) {
    ASSERT_EQ(curve.points.size(), curve.vertices.size());
    ASSERT_EQ(curve.points.size(), curve.steps_per_size.size() + 1);
    EXPECT_GT(curve.points.size(), 7u) << "finer than the mesh";
    EXPECT_TRUE(curve.vertices.front().is_valid() && curve.vertices.back().is_valid());
    for (const double steps : curve.steps_per_size) EXPECT_NEAR(steps, 1, 1e-4);
  }
}

std::map<long, int> kept_by_radius(const FeatureMesh& mesh) {
  std::map<long, int> count;
  for (const auto v : mesh.vertices())
    if (mesh.is_kept(v)) ++count[std::lround(std::hypot(mesh.position(v).x, mesh.position(v).y))];
  return count;
}

TEST(CurveRows, AreAsManyOnBothRimsOfARing) {
  FeatureMesh mesh = feature_mesh_of(ring(120, 4, 6, 2));
  FeatureMesh evenly = mesh;
  sample_feature_curves(evenly, 0.5, 0.05);
  EXPECT_EQ(kept_by_radius(evenly)[4] / 2, 50);
  EXPECT_EQ(kept_by_radius(evenly)[6] / 2, 76);
  sample_feature_curves(mesh, curves_of(mesh, 0.5), 0.5, 0.05);
  EXPECT_NEAR(kept_by_radius(mesh)[4] / 2, 62, 4);
  EXPECT_NEAR(kept_by_radius(mesh)[6] / 2, 62, 4);
}

TEST(CurveRows, GiveWayToTheDeviation) {
  FeatureMesh mesh = feature_mesh_of(ring(480, 4, 6, 2));
  FeatureMesh evenly = mesh;
  sample_feature_curves(evenly, 0.5, 0.002);
  sample_feature_curves(mesh, curves_of(mesh, 0.5), 0.5, 0.002);
  EXPECT_NEAR(kept_by_radius(evenly)[4] / 2, 100, 4);  // 1 - cos(pi / n) is the sagitta
  EXPECT_EQ(kept_by_radius(mesh), kept_by_radius(evenly));
}

TEST(CurveRows, AreNearlyAsManyOnBothSidesOfATrapezoid) {
  double below = 0, above = 0;
  std::vector<int> along;
  for (const MeasuredCurve& curve : curves_of(feature_mesh_of(trapezoid(0.8)), 1)) {
    const Vec3 from = curve.points.front(), to = curve.points.back();
    double steps = 0;
    for (std::size_t i = 0; i + 1 < curve.points.size(); ++i)
      steps += curve.steps_per_size[i] * norm(curve.points[i + 1] - curve.points[i]);
    if (from.y == to.y && from.z == to.z) {
      (from.z == 0 ? below : above) = steps;
      along.push_back(curve.steps.value_or(0));
    } else {
      EXPECT_NEAR(steps, norm(to - from), 0.35);
    }
  }
  EXPECT_NEAR(below, 10.8, 0.2) << "12 long";
  EXPECT_NEAR(above, 10.7, 0.2) << "9.6 long";
  EXPECT_EQ(along, std::vector<int>(4, 11)) << "whole, and the same on both sides";
}

TEST(CurveRows, OfASmoothSurfaceAreNone) {
  EXPECT_TRUE(curves_of(feature_mesh_of(sphere({0, 0, 0}, 2, 24)), 0.3).empty());
}

TEST(SurfaceCurl, StretchesRowsBetweenThePointsOfFeatures) {
  // Ten steps of 1.2 below, and as many of 0.96 above.
  FeatureMesh mesh = feature_mesh_of(trapezoid(0.8));
  const auto is_along_x = [](const MeasuredCurve& curve) { return curve.points.front().x * curve.points.back().x < 0; };
  std::vector<MeasuredCurve> curves = curves_of(mesh, 1);
  for (MeasuredCurve& curve : curves) {
    const double steps = is_along_x(curve) ? 10 / norm(curve.points.back() - curve.points.front()) : 1;
    curve.steps.reset();
    curve.steps_per_size.assign(curve.steps_per_size.size(), steps);
  }
  sample_feature_curves(mesh, curves, 1, 0.1);
  refine_surface(mesh, 1.3, 1e-5);
  std::vector<Vertex> kept;
  for (const auto v : mesh.vertices())
    if (mesh.is_kept(v)) kept.push_back(v.idx());
  const FieldSurface surface(mesh, 1);
  const CrossField field = cross_field(surface);
  const SurfaceLattice lattice = surface_lattice({surface, field, {}, kept}, kept, {}, {});
  ASSERT_EQ(lattice.spacing.size(), surface.triangles.size());
  std::array<double, 2> sum{}, area{};  // below, above
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    if (std::abs(surface.normals[f].z) < 0.9) continue;
    const std::size_t side = surface.centres[f].z < 2 ? 0 : 1;
    sum[side] += surface.areas[f] * lattice.spacing[f][std::abs(field.directions[f].x) > 0.7 ? 0 : 1];
    area[side] += surface.areas[f];
  }
  EXPECT_NEAR(sum[0] / area[0], 1.2, 0.05);
  EXPECT_NEAR(sum[1] / area[1], 0.97, 0.02);
}

}  // namespace
}  // namespace hexpipe
