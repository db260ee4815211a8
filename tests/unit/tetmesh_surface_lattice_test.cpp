#include "tools/tetmesh/surface/surface_lattice.hpp"

#include <gtest/gtest.h>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/surface/feature_curves.hpp"
#include "tools/tetmesh/surface/surface_refine.hpp"

namespace hexpipe {
namespace {

using testing::box;
using testing::Facets;
using testing::sphere;
using testing::surface_of;

// As a surface is remeshed: features sampled, triangles refined.
struct Prepared {
  Prepared(const Facets& facets, double size) : Prepared(mesh_of(facets, size), size) {}

  std::vector<Vertex> kept;
  FieldSurface surface;
  CrossField field;
  std::vector<SurfacePoint> points;

 private:
  Prepared(const FeatureMesh& mesh, double size)
      : kept(kept_of(mesh)),
        surface(mesh),
        field(cross_field(surface, size)),
        points(surface_lattice(surface, field, kept, size).points) {}

  static FeatureMesh mesh_of(const Facets& facets, double size) {
    FeatureMesh mesh(surface_of(facets), 40);
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
