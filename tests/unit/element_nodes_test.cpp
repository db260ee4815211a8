#include "formats/meshes/element_nodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "common/curved/nodes.hpp"
#include "formats/meshes/mesh_writing.hpp"

namespace hexpipe::formats {
namespace {

constexpr std::array<std::uint8_t, 6> kinds{12, 13, 14, 10, vtk_code_of_triangle, vtk_code_of_quad};

TEST(ElementNodes, ListEachNodeOnce) {
  for (const NodeLists& lists : {vtk_nodes, gmsh_nodes, abaqus_nodes, exodus_nodes, med_nodes})
    for (const std::uint8_t vtk : kinds)
      for (const bool full : {false, true}) {
        const auto order = node_order(lists, vtk, true, full);
        const std::size_t corners = node_order(lists, vtk, false, false).size();
        const std::set<std::size_t> different(order.begin(), order.end());
        EXPECT_EQ(different.size(), order.size());
        EXPECT_LT(*different.rbegin(), corners + node_places_of(vtk).count(full));
        const std::size_t edges_alone = corners + node_places_of(vtk).count(false);
        EXPECT_TRUE(full || order.size() == edges_alone);
      }
}

// Gmsh's manual lists the nodes of a hex by their edges: (0,1), (0,3), (0,4), (1,2), ...
TEST(ElementNodes, FollowGmshsManual) {
  const auto order = node_order(gmsh_nodes, 12, true, false);
  EXPECT_EQ(std::vector<std::size_t>(order.begin() + 8, order.begin() + 12), (std::vector<std::size_t>{8, 11, 16, 9}));
  EXPECT_EQ(node_order(gmsh_nodes, 10, true, false), (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7, 9, 8}));
}

// A hex with a pyramid on its upper side.
MixedMesh hex_and_pyramid() {
  MixedMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},      {0, 0, 1},
                 {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0.5, 0.5, 1.6}};
  mesh.hexes.cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
  mesh.hexes.tags = {1};
  mesh.pyramids.cells = {{4, 5, 6, 7, 8}};
  mesh.pyramids.tags = {2};
  mesh.triangles.cells = {{4, 5, 8}};
  mesh.triangles.tags = {3};
  return mesh;
}

// Each node of the elements lies in the middle of its edge, as all edges are straight.
template <class Cells>
void expect_straight(const MixedMesh& mesh, std::uint8_t vtk, const Cells& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto edges = node_places_of(vtk).edges;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const Vec3 middle = 0.5 * (mesh.points[cells[i][edges[e][0]]] + mesh.points[cells[i][edges[e][1]]]);
      EXPECT_LT(norm(mesh.points[mesh.second_order->of(vtk, i)[e]] - middle), 1e-12);
    }
  }
}

TEST(SplitPyramids, TieTheNodesOnTheQuadOfAHex) {
  for (const bool full : {false, true}) {
    MixedMesh mesh = hex_and_pyramid();
    curved::add_straight_nodes(mesh, full);
    std::vector<TiedNode> tied;
    const MixedMesh split = with_split_pyramids(mesh, &tied);
    EXPECT_EQ(split.tets.size(), 4u);
    EXPECT_EQ(split.second_order->tets.size(), 24u);
    expect_straight(split, 10, split.tets.cells);
    // The middle of the base, the middles of lines to its corners; and that of the line to the apex, which is not tied.
    EXPECT_EQ(split.points.size(), mesh.points.size() + (full ? 5 : 6));
    EXPECT_EQ(tied.size(), full ? 4u : 5u);
    for (const TiedNode& node : tied) {
      Vec3 at;
      double sum = 0;
      for (const auto& [v, factor] : node.terms) at += factor * split.points[v], sum += factor;
      EXPECT_EQ(sum, 1);
      EXPECT_LT(norm(at - split.points[node.node]), 1e-12);
    }
  }
}

// Without the hex, the base is a facet of the boundary, and becomes triangles.
TEST(SplitPyramids, CutFacetsThatTheyAloneHave) {
  MixedMesh mesh = hex_and_pyramid();
  mesh.hexes = {};
  mesh.quads.cells = {{4, 7, 6, 5}};
  mesh.quads.tags = {5};
  curved::add_straight_nodes(mesh, false);
  std::vector<TiedNode> tied;
  const MixedMesh split = with_split_pyramids(mesh, &tied);
  EXPECT_TRUE(tied.empty());
  EXPECT_EQ(split.triangles.size(), 5u);
  EXPECT_EQ(split.quads.size(), 0u);
  expect_straight(split, 5, split.triangles.cells);
}

}  // namespace
}  // namespace hexpipe::formats
