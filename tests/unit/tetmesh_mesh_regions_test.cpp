#include "tools/tetmesh/surface/mesh_regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "common/run/parallel.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe {
using namespace tetmesh::solid;
using namespace tetmesh::surface;
namespace {

using testing::sphere;
using testing::surface_of;

class OnASphere : public ::testing::Test {
 protected:
  Surface surface = surface_of(sphere({1, 2, 3}, 2, 24));
  FeatureMesh mesh{surface, 40};

  std::set<int> neighbours_of(int v) const {
    std::set<int> neighbours;
    for (const Triangle& t : surface.triangles)
      if (std::ranges::find(t, v) != t.end()) neighbours.insert(t.begin(), t.end());
    return neighbours;
  }
};

using MeshRegionsTest = OnASphere;

TEST_F(MeshRegionsTest, AreHalvesOfHalves) {
  for (const std::size_t parts : {2u, 4u, 8u}) {
    const MeshRegions regions(mesh, mesh.n_vertices() / parts + 1);
    ASSERT_EQ(regions.size(), parts);
    std::vector<std::size_t> counts(parts);
    for (const auto v : mesh.vertices()) ++counts.at(regions.of(v));
    for (const std::size_t count : counts)
      EXPECT_NEAR(static_cast<double>(count), static_cast<double>(mesh.n_vertices()) / static_cast<double>(parts),
                  1.01);
  }
  EXPECT_EQ(MeshRegions(mesh, 2 * mesh.n_vertices()).size(), 2u);
  EXPECT_EQ(MeshRegions(mesh, 5 * mesh.n_vertices()).size(), 1u);
  EXPECT_EQ(MeshRegions(mesh, 1).size(), 64u);
}

TEST_F(MeshRegionsTest, HaveAVertexWithAllThatIsTwoEdgesAway) {
  const MeshRegions regions(mesh, mesh.n_vertices() / 2);
  std::size_t inside = 0, outside = 0;
  for (const auto v : mesh.vertices()) {
    std::set<int> reached;
    for (const int u : neighbours_of(v.idx())) reached.merge(neighbours_of(u));
    const bool expected = std::ranges::all_of(
        reached, [&](int u) { return regions.of(mesh.vertex_handle(static_cast<unsigned>(u))) == regions.of(v); });
    EXPECT_EQ(regions.has_around(regions.of(v), mesh, v), expected);
    ++(expected ? inside : outside);
  }
  EXPECT_GT(inside, 100u);
  EXPECT_GT(outside, 50u);
}

TEST_F(MeshRegionsTest, HaveAnEdgeWithBothItsTriangles) {
  const MeshRegions regions(mesh, mesh.n_vertices() / 2);
  for (const auto e : mesh.edges()) {
    std::set<std::size_t> found;
    for (const unsigned side : {0u, 1u})
      for (const auto v : mesh.corners(mesh.face_handle(mesh.halfedge_handle(e, side)))) found.insert(regions.of(v));
    EXPECT_EQ(regions.has(*found.begin(), EdgeDiamond(mesh, e)), found.size() == 1);
  }
}

// Every fourth vertex stays.
std::vector<std::array<int, 3>> remaining_faces(FeatureMesh mesh, const DistanceIndex& original) {
  for (const auto v : mesh.vertices())
    if (v.idx() % 4 == 0) mesh.keep(v);
  EXPECT_EQ(remove_vertices(mesh, original, {0.1, 10}), 0u);
  std::vector<std::array<int, 3>> faces;
  for (const auto f : mesh.faces()) {
    const auto [a, b, c] = mesh.corners(f);
    faces.push_back({a.idx(), b.idx(), c.idx()});
  }
  return faces;
}

TEST(RemoveVertices, LeaveTheSameFacesOnAnyNumberOfThreads) {
  const Surface surface = surface_of(sphere({0, 0, 0}, 5, 70));
  const FeatureMesh mesh(surface, 40);
  ASSERT_GT(MeshRegions(mesh, region_vertices).size(), 1u);
  const DistanceIndex original(surface.points, surface.triangles);
  std::vector<std::array<int, 3>> one;
  {
    const ThreadLimit threads(1);
    one = remaining_faces(mesh, original);
  }
  EXPECT_EQ(one.size(), 2 * ((mesh.n_vertices() + 3) / 4) - 4);
  for (int run = 0; run < 5; ++run) {
    const ThreadLimit threads(8);
    EXPECT_EQ(remaining_faces(mesh, original), one);
  }
}

}  // namespace
}  // namespace hexpipe
