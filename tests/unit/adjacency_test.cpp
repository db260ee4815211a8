#include "common/mesh/adjacency.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "common/mesh/cell_topology.hpp"
#include "common/run/error.hpp"
#include "common/run/random.hpp"

namespace hexpipe {
namespace {

using ::testing::ElementsAre;

// Two tets on the facet 1 2 3, and vertex 5 that no tet uses.
TetMesh two_tets() {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {9, 9, 9}};
  mesh.tets = {{0, 1, 2, 3}, {1, 4, 2, 3}};
  mesh.tet_tags = {1, 2};
  return mesh;
}

TEST(TetAdjacency, KnowsTheTetBeyondEachFacet) {
  const TetMesh mesh = two_tets();
  const TetAdjacency adjacency(mesh, "test");
  EXPECT_THAT(adjacency.tets_beyond(TetIndex(0)), ElementsAre(1, -1, -1, -1));
  EXPECT_THAT(adjacency.tets_beyond(TetIndex(1)), ElementsAre(-1, 0, -1, -1));
}

TEST(TetAdjacency, KnowsWhatIsAroundAVertex) {
  const TetMesh mesh = two_tets();
  const TetAdjacency adjacency(mesh, "test");
  EXPECT_THAT(adjacency.tets_at(1), ElementsAre(0, 1));
  EXPECT_THAT(adjacency.tets_at(4), ElementsAre(1));
  EXPECT_THAT(adjacency.tets_at(5), ElementsAre());
  EXPECT_THAT(adjacency.neighbours_of(4), ElementsAre(1, 2, 3));
  EXPECT_THAT(adjacency.neighbours_of(1), ElementsAre(0, 2, 3, 4));
  EXPECT_TRUE(adjacency.has_edge(3, 4));
  EXPECT_FALSE(adjacency.has_edge(0, 4));
}

TEST(TetAdjacency, ThreeTetsAtAFacetAreAnError) {
  TetMesh mesh = two_tets();
  mesh.tets.push_back({5, 1, 2, 3});
  mesh.tet_tags.push_back(1);
  EXPECT_THAT(
      [&] { TetAdjacency(mesh, "m.mesh"); },
      ::testing::ThrowsMessage<DataError>("m.mesh: expected at most two tets at each facet, found tets 1, 2 and 3 "
                                          "at vertices 2 3 4"));
}

TEST(AddMissingBoundaryTriangles, CompletesBoundaryAndInterface) {
  TetMesh mesh = two_tets();
  mesh.triangles = {{2, 1, 0}};
  mesh.triangle_tags = {7};
  const TetAdjacency adjacency(mesh, "test");
  EXPECT_EQ(add_missing_boundary_triangles(mesh, adjacency, 3), 6u);
  EXPECT_THAT(mesh.triangle_tags, ElementsAre(7, 3, 3, 3, 3, 3, 3));
  std::set<std::set<Vertex>> triangles;
  for (const Triangle& t : mesh.triangles) triangles.insert({t.begin(), t.end()});
  EXPECT_EQ(triangles.size(), 7u);
  EXPECT_TRUE(triangles.contains({1, 2, 3}));
  EXPECT_EQ(add_missing_boundary_triangles(mesh, adjacency, 3), 0u);
}

// In a lattice of cubes cut into six tets, against a search through all pairs of tets.
TEST(TetAdjacency, AgreesWithBruteForceOnALattice) {
  constexpr int n = 3;
  TetMesh mesh;
  auto vertex = [](int i, int j, int k) { return static_cast<Vertex>((i * (n + 1) + j) * (n + 1) + k); };
  mesh.points.resize((n + 1) * (n + 1) * (n + 1));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        std::array<int, 3> axes{0, 1, 2};
        do {
          std::array<int, 3> at{i, j, k};
          Tet tet{vertex(i, j, k)};
          for (int step = 0; step < 3; ++step) {
            ++at[axes[step]];
            tet[step + 1] = vertex(at[0], at[1], at[2]);
          }
          mesh.tets.push_back(tet);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  mesh.tet_tags.assign(mesh.tets.size(), 0);
  const TetAdjacency adjacency(mesh, "test");
  for (const auto a : indices<TetIndex>(mesh.tets.size()))
    for (int facet = 0; facet < 4; ++facet) {
      TetIndex expected = no_index;
      for (const auto b : indices<TetIndex>(mesh.tets.size())) {
        int shared = 0;
        for (const auto corner : TetTopology::triangles[facet])
          shared += std::count(mesh.tets[b].begin(), mesh.tets[b].end(), mesh.tets[a][corner]);
        if (a != b && shared == 3) expected = b;
      }
      EXPECT_EQ(adjacency.tet_beyond(a, facet), expected);
    }
}

}  // namespace
}  // namespace hexpipe
