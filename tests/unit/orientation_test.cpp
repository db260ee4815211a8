#include "common/mesh/orientation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/run/error.hpp"
#include "common/run/random.hpp"
#include "findhex_meshes.hpp"

namespace hexpipe {
namespace {

using testing::kuhn_lattice;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

bool all_positive(const TetMesh& mesh) {
  return std::ranges::all_of(mesh.tets, [&](const Tet& t) { return tet_determinant(mesh.points, t) > 0; });
}

TEST(OrientTets, LeavesPositiveTetsAlone) {
  const TetMesh mesh = kuhn_lattice(2);
  TetMesh turned = mesh;
  const TetOrientation result = orient_tets(turned, "test");
  EXPECT_EQ(turned, mesh);
  EXPECT_EQ(result.turned + result.inverted + result.flat, 0);
  EXPECT_FALSE(turned_tets_warning(result));
}

TEST(OrientTets, TurnsAllTets) {
  TetMesh mesh = kuhn_lattice(2);
  for (Tet& t : mesh.tets) std::swap(t[1], t[2]);
  const TetOrientation result = orient_tets(mesh, "test");
  EXPECT_TRUE(all_positive(mesh));
  EXPECT_EQ(result.turned, 48);
  EXPECT_EQ(result.inverted, 0);
  EXPECT_FALSE(turned_tets_warning(result));
}

TEST(OrientTets, TurnsTetsListedInNoOrder) {
  TetMesh mesh = kuhn_lattice(3);
  Random random(1);
  std::int64_t odd = 0;
  for (Tet& t : mesh.tets) {
    random.shuffle(std::span<Vertex>(t));
    odd += tet_determinant(mesh.points, t) < 0;
  }
  const TetOrientation result = orient_tets(mesh, "test");
  EXPECT_TRUE(all_positive(mesh));
  EXPECT_EQ(result.turned, odd);
  EXPECT_EQ(result.inverted, 0);
}

// A tet pushed inside out by a vertex is listed as its neighbours are.
TEST(OrientTets, TellsInvertedTetsFromTurnedOnes) {
  for (const bool mirrored : {false, true}) {
    TetMesh mesh = kuhn_lattice(3);
    mesh.points[21] = {2.2, 1, 0.7};
    std::int64_t inverted = 0;
    for (Tet& t : mesh.tets) {
      inverted += tet_determinant(mesh.points, t) < 0;
      if (mirrored) std::swap(t[0], t[1]);
    }
    ASSERT_GT(inverted, 0);
    const TetOrientation result = orient_tets(mesh, "test");
    EXPECT_EQ(result.inverted, inverted);
    EXPECT_EQ(result.turned, mirrored ? 162 : 0);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      EXPECT_EQ(result.signs[t] > 0, tet_determinant(mesh.points, mesh.tets[t]) > 0);
  }
}

TEST(OrientTets, JudgesPartsApart) {
  TetMesh mesh = kuhn_lattice(1);
  const TetMesh other = mesh;
  for (const Vec3& p : other.points) mesh.points.push_back(p + Vec3{5, 0, 0});
  for (Tet t : other.tets) mesh.tets.push_back({t[0] + 8, t[1] + 8, t[3] + 8, t[2] + 8});
  const TetOrientation result = orient_tets(mesh, "test");
  EXPECT_EQ(result.turned, 6);
  EXPECT_TRUE(all_positive(mesh));
}

TEST(OrientTets, CountsFlatTetsAndWarnsOfFewTurnedOnes) {
  TetMesh mesh = kuhn_lattice(2);
  std::swap(mesh.tets[7][0], mesh.tets[7][3]);
  mesh.points[26] = {2, 2, 1};
  const TetOrientation result = orient_tets(mesh, "test");
  EXPECT_EQ(result.turned, 1);
  EXPECT_GT(result.flat, 0);
  EXPECT_EQ(turned_tets_warning(result), "1 of 48 tets listed inside out, unlike their neighbours: turned");
}

TEST(CheckSides, RefusesTwoCopiesOfATet) {
  TetMesh mesh = kuhn_lattice(1);
  EXPECT_NO_THROW(check_sides(mesh, TetAdjacency(mesh, "m.mesh"), "m.mesh"));
  mesh.tets = {mesh.tets[0], mesh.tets[0]};
  const TetAdjacency adjacency(mesh, "m.mesh");
  const std::vector numbers{TetIndex(7), TetIndex(5)};
  EXPECT_THAT([&] { check_sides(mesh, adjacency, "m.mesh", numbers); },
              ThrowsMessage<DataError>(StartsWith(
                  "m.mesh: expected tets on the two sides of a facet, found tets 6 and 8 on one side of that at ")));
}

// Other checks report flat and inverted tets.
TEST(CheckSides, IsSilentAboutInvertedTets) {
  TetMesh mesh = kuhn_lattice(1);
  mesh.tets = {mesh.tets[0], mesh.tets[0]};
  for (Tet& t : mesh.tets) std::swap(t[2], t[3]);
  EXPECT_NO_THROW(check_sides(mesh, TetAdjacency(mesh, "m.mesh"), "m.mesh"));
}

}  // namespace
}  // namespace hexpipe
