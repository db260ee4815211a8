#include <gtest/gtest.h>

#include "common/mesh/adjacency.hpp"
#include "common/run/error.hpp"
#include "tools/assemble/conform/flat_tets.hpp"
#include "tools/assemble/hybrid/extract.hpp"
#include "tools/assemble/self_check.hpp"

namespace hexpipe {
using namespace assemble;
using namespace assemble::conform;
using namespace assemble::hybrid;
using namespace assemble::shape;
namespace {

constexpr Vertex a = 0, b = 1, c = 2, d = 3;

// Two tets side by side under a square, and on top of them a tet that is `height` thick, with edge cd outside.
TetMesh roof(double height) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 1, 0}, {1, 0, height}, {0, 1, height}, {0.5, 0.5, -1}};
  mesh.tets = {{a, c, b, d}, {a, b, c, 4}, {a, d, b, 4}};
  for (auto& tet : mesh.tets)
    if (tet_determinant(mesh.points, tet) < 0) std::swap(tet[2], tet[3]);
  mesh.tet_tags = {1, 1, 1};
  add_missing_boundary_triangles(mesh, TetAdjacency(mesh, "test"), 5);
  return mesh;
}

std::int64_t peel(const TetMesh& mesh, SurfaceTags& tags) {
  HybridMesh hybrid(mesh, std::vector<bool>(mesh.tets.size()));
  return peel_flat_tets(hybrid, tags, InputSurface(mesh, TetAdjacency(mesh, "mesh")), {}, 0.03);
}

TEST(Peel, AFlatTetOnTheBoundaryGoesAndItsInnerFacetsAreBoundary) {
  const TetMesh mesh = roof(0.01);
  SurfaceTags tags(mesh);
  ASSERT_EQ(peel(mesh, tags), 1);
  EXPECT_EQ(tags.size(), mesh.triangles.size());
  EXPECT_EQ(tags.peeled().size(), 1u);
  EXPECT_FALSE(tags.contains({a, c, d}) || tags.contains({b, c, d}));
  for (const Triangle& triangle : {Triangle{a, b, c}, Triangle{a, b, d}}) {
    const auto place = tags.find(triangle);
    ASSERT_TRUE(place);
    EXPECT_EQ(tags.tag_of(*place), 5);
    const auto& [p, q, r] = tags.triangle(*place);
    EXPECT_GT(cross(mesh.points[q] - mesh.points[p], mesh.points[r] - mesh.points[p]).z, 0) << "outward";
  }
}

TEST(Peel, OtherTetsStay) {
  const TetMesh thick = roof(0.1);
  SurfaceTags tags(thick);
  EXPECT_EQ(peel(thick, tags), 0) << "not flat";
  TetMesh mesh = roof(0.01);
  mesh.triangle_tags[static_cast<std::size_t>(*SurfaceTags(mesh).find({a, c, d}))] = 6;
  SurfaceTags border(mesh);
  EXPECT_EQ(peel(mesh, border), 0) << "between two tags";
  mesh = roof(0.01);
  mesh.triangles.push_back({a, b, c});
  mesh.triangle_tags.push_back(7);
  SurfaceTags inner(mesh);
  EXPECT_EQ(peel(mesh, inner), 0) << "a tagged facet inside";
}

// Another tet hangs on the outer edge: without the flat one it would touch the rest in two vertices only.
TEST(Peel, NoTetWhoseOuterEdgeOthersHave) {
  TetMesh mesh = roof(0.01);
  mesh.points.push_back({0, 0, 1});
  mesh.points.push_back({1, 1, 1});
  mesh.tets.push_back({c, d, 5, 6});
  if (tet_determinant(mesh.points, mesh.tets.back()) < 0) std::swap(mesh.tets.back()[2], mesh.tets.back()[3]);
  mesh.tet_tags.push_back(1);
  add_missing_boundary_triangles(mesh, TetAdjacency(mesh, "test"), 5);
  SurfaceTags tags(mesh);
  EXPECT_EQ(peel(mesh, tags), 0);
}

TEST(Peel, TheSelfCheckKnowsOfIt) {
  const TetMesh mesh = roof(0.01);
  const InputSurface surface(mesh, TetAdjacency(mesh, "mesh"));
  SurfaceTags tags(mesh);
  HybridMesh hybrid(mesh, std::vector<bool>(mesh.tets.size()));
  ASSERT_EQ(peel_flat_tets(hybrid, tags, surface, {}, 0.03), 1);
  const auto volumes = check_result(extract(hybrid, tags), mesh, tags, surface, true);
  EXPECT_NEAR(volumes.peeled, 0.01 / 3, 1e-12);
  EXPECT_NEAR(volumes.cells, volumes.input - volumes.peeled, 1e-12);
  EXPECT_NEAR(volumes.deviation, 0.01, 1e-5);
  EXPECT_THROW(check_result(extract(hybrid, tags), mesh, SurfaceTags(mesh), surface, true), DataError);
}

}  // namespace
}  // namespace hexpipe
