#include "tools/tetmesh/tetgen/numbering.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <span>

#include "common/run/random.hpp"
#include "surface_samples.hpp"
#include "tools/tetmesh/tetmesh.hpp"

namespace hexpipe::tetmesh {
namespace {

// Tets with the numbers of their corners replaced by coordinates, and with their tags.
using PlacedTet = std::pair<std::array<std::array<double, 3>, 4>, std::int32_t>;
std::multiset<PlacedTet> placed_tets(const TetMesh& mesh) {
  std::multiset<PlacedTet> placed;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    PlacedTet tet{{}, mesh.tet_tags.empty() ? 0 : mesh.tet_tags[t]};
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3& p = mesh.points[mesh.tets[t][i]];
      tet.first[i] = {p.x, p.y, p.z};
    }
    placed.insert(tet);
  }
  return placed;
}

TetMesh random_tets(std::size_t points, std::size_t tets) {
  Random random(7, 0);
  TetMesh mesh;
  for (std::size_t v = 0; v < points; ++v)
    mesh.points.push_back({random.uniform(-1, 1), random.uniform(0, 5), random.uniform(2, 3)});
  while (mesh.tets.size() < tets) {
    Tet tet;
    for (Vertex& v : tet) v = static_cast<Vertex>(random.below(points));
    if (std::set<Vertex>(tet.begin(), tet.end()).size() < 4) continue;
    mesh.tets.push_back(tet);
    mesh.tet_tags.push_back(static_cast<std::int32_t>(random.below(3)));
    mesh.triangles.push_back({tet[0], tet[1], tet[2]});
    mesh.triangle_tags.push_back(static_cast<std::int32_t>(random.below(3)));
  }
  return mesh;
}

TEST(Numbering, KeepsTheMesh) {
  const TetMesh before = random_tets(60, 200);
  TetMesh after = before;
  tetgen::number_along_curve(after, 0);
  EXPECT_NE(after.points, before.points);
  EXPECT_EQ(placed_tets(after), placed_tets(before));
  EXPECT_EQ(after.triangle_tags, before.triangle_tags);
  for (std::size_t i = 0; i < before.triangles.size(); ++i)
    for (std::size_t corner = 0; corner < 3; ++corner)
      EXPECT_EQ(after.points[after.triangles[i][corner]], before.points[before.triangles[i][corner]]);
}

TEST(Numbering, TetsAscendByTheirLowestVertices) {
  TetMesh mesh = random_tets(60, 200);
  tetgen::number_along_curve(mesh, 0);
  EXPECT_TRUE(std::ranges::is_sorted(mesh.tets, {}, [](const Tet& tet) { return std::ranges::min(tet); }));
}

// The corners of a cube come in the order of the curve's smallest cell, whatever their order was.
TEST(Numbering, FollowsTheCurve) {
  TetMesh mesh;
  for (int corner = 7; corner >= 0; --corner)
    mesh.points.push_back({0.1 + (corner & 1), 5.0 + (corner >> 1 & 1), -3.0 + (corner >> 2 & 1)});
  mesh.tets = {{0, 1, 2, 4}};
  tetgen::number_along_curve(mesh, 0);
  for (int corner = 0; corner < 8; ++corner)
    EXPECT_EQ(mesh.points[corner], (Vec3{0.1 + (corner & 1), 5.0 + (corner >> 1 & 1), -3.0 + (corner >> 2 & 1)}));
  EXPECT_EQ(mesh.tets.front(), (Tet{7, 6, 5, 3}));
}

TEST(Numbering, PointsThatTetGenAddedStayLast) {
  const TetMesh before = random_tets(60, 200);
  TetMesh after = before;
  tetgen::number_along_curve(after, 7);
  EXPECT_TRUE(std::ranges::equal(std::span(after.points).last(7), std::span(before.points).last(7)));
  EXPECT_EQ(placed_tets(after), placed_tets(before));
}

TEST(Numbering, TakesMeshesWithoutExtent) {
  TetMesh mesh;
  tetgen::number_along_curve(mesh, 0);
  EXPECT_TRUE(mesh.points.empty());
  mesh.points = {{1, 2, 3}, {1, 2, 3}};
  tetgen::number_along_curve(mesh, 0);
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{1, 2, 3}, {1, 2, 3}}));
}

TEST(Numbering, IsForLargeMeshesWhoseOrderNobodyWasPromised) {
  const formats::SurfaceSoup soup = testing::soup_of(testing::cube(0, 1, 4));
  const auto mesh_of = [&](SurfaceKind surface, double size) {
    return tetmesh(soup, {.sizes = {.size = sizing::Length{size, false}}, .surface = surface}).mesh;
  };
  const auto ascends = [](const TetMesh& mesh) {
    return std::ranges::is_sorted(mesh.tets, {}, [](const Tet& tet) { return std::ranges::min(tet); });
  };
  const TetMesh anew = mesh_of(SurfaceKind::remesh, 0.045), kept = mesh_of(SurfaceKind::keep, 0.045),
                small = mesh_of(SurfaceKind::remesh, 0.25);
  EXPECT_GT(anew.points.size(), 10000u);
  EXPECT_TRUE(ascends(anew));
  EXPECT_FALSE(ascends(kept));
  EXPECT_FALSE(ascends(small));
  EXPECT_TRUE(std::ranges::equal(soup.points, std::span(kept.points).first(soup.points.size())));
}

}  // namespace
}  // namespace hexpipe::tetmesh
