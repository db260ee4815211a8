#include <gtest/gtest.h>

#include <algorithm>

#include "assemble_lattice.hpp"
#include "common/mesh/adjacency.hpp"
#include "common/mesh/cell_topology.hpp"
#include "tests/unit/list_of.hpp"
#include "tools/assemble/assemble.hpp"

namespace hexpipe {
using namespace assemble::conform;
using namespace assemble::hybrid;
using namespace assemble;
using namespace graph;
namespace {

using testing::jitter;
using testing::make_lattice;
using testing::random_choice;

constexpr AssembleOptions conforming{.conformity = AssembleOptions::Conformity::pyramids, .smooth = 0};

// assemble() checks every result itself (self_check_test shows that the check can fail), so that these have to look at
// what it does, not whether it is valid.

TEST(Conform, OneCubeAmongTetsKeepsItsHexAndGetsAPyramidOnEachSide) {
  const auto lattice = make_lattice(3);
  const AssembleResult result = assemble::assemble(lattice.mesh, lattice.cubes, {13}, conforming);
  EXPECT_EQ(result.mesh.hexes.size(), 1u);
  EXPECT_EQ(result.mesh.pyramids.size(), 6u);
  EXPECT_EQ(result.statistics.volumes.nonconforming_quads, 0);
  EXPECT_NEAR(result.statistics.volumes.cells, 27, 1e-9);
  EXPECT_GT(result.statistics.kinds[2].least, 0.1);
}

TEST(Conform, AllCubesNeedNothing) {
  const auto lattice = make_lattice(2);
  const AssembleResult result = assemble::assemble(lattice.mesh, lattice.cubes, {0, 1, 2, 3, 4, 5, 6, 7}, conforming);
  EXPECT_EQ(result.mesh.hexes.size(), 8u);
  EXPECT_EQ(result.statistics.cells(), 8);
  EXPECT_EQ(result.mesh.quads.size(), 24u);
  EXPECT_EQ(result.mesh.triangles.size(), 0u);
  EXPECT_EQ(result.mesh.points, lattice.mesh.points);
}

TEST(Conform, RandomChoicesOnJitteredLatticesStayConforming) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = make_lattice(5);
    jitter(lattice, 0.15, random);
    const auto chosen = random_choice(lattice, random.uniform(0.1, 0.9), random);
    const AssembleResult result = assemble::assemble(lattice.mesh, lattice.cubes, chosen, conforming);
    EXPECT_EQ(result.statistics.volumes.nonconforming_quads, 0);
    std::int64_t given_back = 0;
    for (auto count : result.statistics.conformity.given_back) given_back += count;
    EXPECT_EQ(result.statistics.kinds[0].count + result.statistics.kinds[1].count + given_back,
              static_cast<std::int64_t>(chosen.size()) + result.statistics.filling_prisms);
    RecordProperty("given_back_" + std::to_string(seed), static_cast<int>(given_back));
  }
}

// Tags some facets between tets of cubes that are not chosen; returns how many.
std::int64_t tag_inner_facets(testing::Lattice& lattice, const IndependentSet& chosen, std::int32_t tag,
                              Random& random) {
  const TetAdjacency adjacency(lattice.mesh, "lattice");
  const auto is_chosen = [&](TetIndex tet) { return std::ranges::binary_search(chosen, tet / 6); };
  for (const auto t : indices<TetIndex>(lattice.mesh.tets.size()))
    for (int facet = 0; facet < 4; ++facet) {
      const TetIndex beyond = adjacency.tet_beyond(t, facet);
      if (beyond < t || is_chosen(t) || is_chosen(beyond) || random.uniform() > 0.06) continue;
      const Tet& tet = lattice.mesh.tets[t];
      const auto& f = TetTopology::triangles[facet];
      lattice.mesh.triangles.push_back({tet[f[0]], tet[f[1]], tet[f[2]]});
      lattice.mesh.triangle_tags.push_back(tag);
    }
  return static_cast<std::int64_t>(lattice.mesh.triangles.size());
}

TEST(Conform, TaggedTrianglesInsideStay) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = make_lattice(4);
    jitter(lattice, 0.2, random);
    const auto chosen = random_choice(lattice, random.uniform(0.1, 0.5), random);
    const std::int64_t tagged = tag_inner_facets(lattice, chosen, 5, random);
    for (const int smooth : {0, 5}) {
      const AssembleResult result = assemble::assemble(lattice.mesh, lattice.cubes, chosen, {.smooth = smooth});
      // Two of them may have become the quad of a prism.
      EXPECT_EQ(std::ranges::count(result.mesh.triangles.tags, 5) + 2 * std::ranges::count(result.mesh.quads.tags, 5),
                tagged);
    }
  }
}

// A sheared box whose sides have a tag each, so that no vertex may move.
TEST(Conform, AHexThatStaysPoorGoesBack) {
  auto lattice = make_lattice(1);
  TetMesh& mesh = lattice.mesh;
  add_missing_boundary_triangles(mesh, TetAdjacency(mesh, "lattice"), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      for (const int end : {0, 1})
        if (std::ranges::all_of(mesh.triangles[i], [&](Vertex v) { return mesh.points[v][axis] == end; }))
          mesh.triangle_tags[i] = 2 * axis + end;
  for (Vec3& p : mesh.points) p.x += 12 * p.z;
  const AssembleResult result = assemble::assemble(mesh, lattice.cubes, {0}, {});
  EXPECT_EQ(result.mesh.hexes.size(), 0u);
  EXPECT_EQ(result.mesh.tets.size(), 6u);
  EXPECT_EQ(result.statistics.conformity.given_back[static_cast<std::size_t>(GivenBack::poor_elements)], 1);
  for (Vec3& p : mesh.points) p.x -= 4 * p.z;  // a scaled Jacobian of 0.12
  EXPECT_EQ(assemble::assemble(mesh, lattice.cubes, {0}, {}).mesh.hexes.size(), 1u);
}

// Two pyramids whose common quad is a hole of the mesh: a missing tet. With a quad on one side the hole would have two
// triangles on the other, with quads on both sides there would be no hole.
TEST(Conform, CellsThatWouldCloseAHoleGoBack) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0.1}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}};
  mesh.tets = {{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 3, 1, 5}, {1, 3, 2, 5}};
  for (auto& tet : mesh.tets)
    if (tet_determinant(mesh.points, tet) < 0) std::swap(tet[2], tet[3]);
  mesh.tet_tags = {1, 1, 1, 1};
  Candidates pyramids;
  pyramids.vertices = {{0, 1, 2, 3, 4, -1, -1, -1}, {0, 3, 2, 1, 5, -1, -1, -1}};
  pyramids.kind = {CellKind::pyramid, CellKind::pyramid};
  pyramids.quality = {0.5, 0.5};
  pyramids.volume = {0.3, 0.3};
  pyramids.tets = testing::list_of<TetIndex>({0, 1, 2, 3});
  pyramids.tet_offsets = {0, 2, 4};
  pyramids.boundary_tet_offsets = {0, 0, 0};
  for (const IndependentSet& chosen : {IndependentSet{0}, IndependentSet{1}, IndependentSet{0, 1}}) {
    const auto result = assemble::assemble(mesh, pyramids, chosen, {});
    EXPECT_EQ(result.mesh.tets.size(), 4u);
    EXPECT_EQ(result.mesh.triangles.size(), 12u);
    EXPECT_EQ(result.statistics.conformity.given_back[static_cast<std::size_t>(GivenBack::diagonal_on_surface)],
              static_cast<std::int64_t>(chosen.size()));
  }
}

// The same with the tet below that has one of the two triangles: between it and the quad there is a slit.
TEST(Conform, ACellThatWouldCloseASlitGoesBack) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0.1}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}};
  mesh.tets = {{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 3, 1, 5}};
  for (auto& tet : mesh.tets)
    if (tet_determinant(mesh.points, tet) < 0) std::swap(tet[2], tet[3]);
  mesh.tet_tags = {1, 1, 1};
  Candidates pyramid;
  pyramid.vertices = {{0, 1, 2, 3, 4, -1, -1, -1}};
  pyramid.kind = {CellKind::pyramid};
  pyramid.quality = {0.5};
  pyramid.volume = {0.3};
  pyramid.tets = testing::list_of<TetIndex>({0, 1});
  pyramid.tet_offsets = {0, 2};
  pyramid.boundary_tet_offsets = {0, 0};
  const auto result = assemble::assemble(mesh, pyramid, {0}, {});
  EXPECT_EQ(result.mesh.tets.size(), 3u);
  EXPECT_EQ(result.mesh.pyramids.size(), 0u);
  EXPECT_EQ(result.statistics.conformity.given_back[static_cast<std::size_t>(GivenBack::diagonal_on_surface)], 1);
}

}  // namespace
}  // namespace hexpipe
