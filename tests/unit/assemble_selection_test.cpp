#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assemble_lattice.hpp"
#include "common/run/error.hpp"
#include "tests/unit/list_of.hpp"
#include "tools/assemble/assemble.hpp"

namespace hexpipe {
using namespace assemble;
using namespace graph;
namespace {

using ::testing::HasSubstr;
using testing::jitter;
using testing::Lattice;
using testing::make_lattice;
using testing::random_choice;

constexpr AssembleOptions plain{.conformity = AssembleOptions::Conformity::none, .smooth = 0};

std::string error_of(const Lattice& lattice, const Candidates& candidates, const IndependentSet& chosen) {
  try {
    assemble::assemble(lattice.mesh, candidates, chosen, plain);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

void append_copy(Candidates& candidates, std::size_t i) {
  const auto interior = candidates.interior_tets_of(i);
  const std::vector<TetIndex> tets(interior.begin(), interior.end());
  candidates.vertices.push_back(candidates.vertices[i]);
  candidates.kind.push_back(candidates.kind[i]);
  candidates.quality.push_back(candidates.quality[i]);
  candidates.volume.push_back(candidates.volume[i]);
  candidates.tets.insert(candidates.tets.end(), tets.begin(), tets.end());
  candidates.tet_offsets.push_back(static_cast<std::int64_t>(candidates.tets.size()));
  candidates.boundary_tet_offsets.push_back(static_cast<std::int64_t>(candidates.boundary_tets.size()));
}

TEST(Selection, NothingChosenGivesTheTetsBack) {
  const auto lattice = make_lattice(2);
  const AssembleResult result = assemble::assemble(lattice.mesh, lattice.cubes, {}, plain);
  EXPECT_EQ(result.mesh.tets.cells, lattice.mesh.tets);
  EXPECT_EQ(result.mesh.tets.tags, lattice.mesh.tet_tags);
  EXPECT_EQ(result.mesh.points, lattice.mesh.points);
  EXPECT_EQ(result.mesh.triangles.size(), 48u);
  EXPECT_EQ(result.mesh.quads.size(), 0u);
}

TEST(Selection, AChosenCubeReplacesItsSixTets) {
  const auto lattice = make_lattice(2);
  const AssembleResult result = assemble::assemble(lattice.mesh, lattice.cubes, {5}, plain);
  EXPECT_EQ(result.mesh.hexes.cells, (std::vector{lattice.cubes.vertices[5]}));
  EXPECT_EQ(result.mesh.tets.size(), 42u);
  // Three of its sides lie on the boundary, three face tets.
  EXPECT_EQ(result.mesh.quads.size(), 3u);
  EXPECT_EQ(result.mesh.triangles.size(), 42u);
  EXPECT_EQ(result.statistics.volumes.nonconforming_quads, 3);
  EXPECT_DOUBLE_EQ(result.statistics.kinds[0].volume, 1);
  EXPECT_DOUBLE_EQ(result.statistics.kinds[0].least, 1);
  EXPECT_DOUBLE_EQ(result.statistics.kinds[3].volume, 7);
}

TEST(Selection, VerticesInsideACellAreDropped) {
  // One of the cube's tets is cut into four around its middle.
  auto lattice = make_lattice(1);
  const Tet tet = lattice.mesh.tets[0];
  lattice.mesh.points.push_back((lattice.mesh.points[tet[0]] + lattice.mesh.points[tet[1]] +
                                 lattice.mesh.points[tet[2]] + lattice.mesh.points[tet[3]]) *
                                0.25);
  for (int i = 0; i < 4; ++i) {
    Tet part = tet;
    part[i] = 8;
    if (i == 0) {
      lattice.mesh.tets[0] = part;
      continue;
    }
    lattice.cubes.tets.emplace_back(lattice.mesh.tets.size());
    lattice.mesh.tets.push_back(part);
    lattice.mesh.tet_tags.push_back(1);
  }
  lattice.cubes.tet_offsets[1] = 9;
  const AssembleResult result = assemble::assemble(lattice.mesh, lattice.cubes, {0}, plain);
  EXPECT_EQ(result.mesh.points.size(), 8u);
  EXPECT_EQ(result.statistics.cells(), 1);
}

TEST(Selection, PartsAddUpWithTheBulgesOfWarpedQuads) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = make_lattice(4);
    jitter(lattice, 0.2, random);
    // A warped boundary quad as well.
    lattice.mesh.points[testing::lattice_vertex(4, 0, 2, 2)].x -= 0.1;
    const auto chosen = random_choice(lattice, 0.6, random);
    const auto volumes = assemble::assemble(lattice.mesh, lattice.cubes, chosen, plain).statistics.volumes;
    EXPECT_NE(volumes.open_bulge, 0);
    EXPECT_NEAR(volumes.cells, volumes.input + volumes.bulge + volumes.open_bulge, 1e-9);
    EXPECT_NEAR(volumes.skin, volumes.cells, 1e-9);
  }
}

TEST(Selection, RegionsAndSurfaceTagsAreCarried) {
  auto lattice = make_lattice(2, [](int i, int, int) { return i == 0 ? 7 : 9; });
  // The interface x = 1, tagged 5; the boundary is left to be found.
  for (const Tet& tet : lattice.mesh.tets)
    for (const auto& f : TetTopology::triangles) {
      const Triangle triangle{tet[f[0]], tet[f[1]], tet[f[2]]};
      auto on_interface = [&](Vertex v) { return lattice.mesh.points[v].x == 1; };
      const bool from_left = lattice.mesh.tet_tags[&tet - lattice.mesh.tets.data()] == 7;
      if (!from_left || !std::all_of(triangle.begin(), triangle.end(), on_interface)) continue;
      lattice.mesh.triangles.push_back(triangle);
      lattice.mesh.triangle_tags.push_back(5);
    }
  ASSERT_EQ(lattice.mesh.triangles.size(), 8u);
  for (const auto conformity : {AssembleOptions::Conformity::none, AssembleOptions::Conformity::pyramids}) {
    const auto mesh =
        assemble::assemble(lattice.mesh, lattice.cubes, {0, 7}, {.conformity = conformity, .smooth = 0}).mesh;
    EXPECT_EQ(mesh.hexes.tags, (std::vector<std::int32_t>{7, 9}));
    EXPECT_EQ(std::count(mesh.quads.tags.begin(), mesh.quads.tags.end(), 5), 2);
    EXPECT_EQ(std::count(mesh.triangles.tags.begin(), mesh.triangles.tags.end(), 5), 4);
    EXPECT_EQ(std::count(mesh.quads.tags.begin(), mesh.quads.tags.end(), 0), 6);
  }
}

TEST(Selection, OverlappingCandidatesAreAnError) {
  auto lattice = make_lattice(2);
  append_copy(lattice.cubes, 3);
  EXPECT_THAT(error_of(lattice, lattice.cubes, {3, 8}), HasSubstr("4 and 9 which share a tet"));
}

TEST(Selection, CandidatesOfAnotherMeshAreAnError) {
  const auto lattice = make_lattice(2);
  auto shifted = lattice.cubes;
  for (TetIndex& t : shifted.tets) t = TetIndex((t + 1) % 48);
  EXPECT_THAT(error_of(lattice, shifted, {0}), HasSubstr("candidates of this mesh"));
  const auto larger = make_lattice(3);
  EXPECT_NE(error_of(lattice, larger.cubes, {0}), "no error");
  auto twisted = lattice.cubes;
  std::swap(twisted.vertices[0][1], twisted.vertices[0][2]);
  EXPECT_THAT(error_of(lattice, twisted, {0}), HasSubstr("candidate 1 whose tets do not form it"));
}

TEST(Selection, InvalidCandidatesAreToldByTheirNumbers) {
  const auto lattice = make_lattice(2);
  auto mirrored = lattice.cubes;
  std::swap(mirrored.vertices[1][1], mirrored.vertices[1][3]);
  std::swap(mirrored.vertices[1][5], mirrored.vertices[1][7]);
  EXPECT_THAT(error_of(lattice, mirrored, {0, 1}),
              HasSubstr("candidates: expected valid cells, found candidate 2 whose Jacobian"));
  EXPECT_EQ(error_of(lattice, mirrored, {0}), "no error");
}

TEST(Selection, DiagonalsThatAreEdgesOfOthersAreAnError) {
  // A pyramid on 0123, with the diagonal 02 between its tets, below a ring of tets around 02; and one of this ring in a
  // pyramid on 0276, with the edge 02.
  Lattice lattice{};
  lattice.mesh.points = {{0, 0, 0}, {1, -1, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, -1}, {1, -1, 1}, {0, 1, 1}, {2, 1, 1.1}};
  lattice.mesh.tets = {{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 2, 1, 5}, {0, 2, 5, 6},
                       {2, 7, 5, 6}, {0, 2, 6, 3}, {2, 7, 6, 3}};
  for (Tet& tet : lattice.mesh.tets)
    if (tet_determinant(lattice.mesh.points, tet) < 0) std::swap(tet[2], tet[3]);
  lattice.mesh.tet_tags.assign(lattice.mesh.tets.size(), 1);
  Candidates pyramids;
  pyramids.vertices = {{0, 3, 2, 1, 4, -1, -1, -1}, {0, 2, 7, 6, 5, -1, -1, -1}};
  pyramids.kind = {CellKind::pyramid, CellKind::pyramid};
  pyramids.quality = pyramids.volume = {0.5, 0.5};
  pyramids.tets = testing::list_of<TetIndex>({0, 1, 3, 4});
  pyramids.tet_offsets = {0, 2, 4};
  pyramids.boundary_tet_offsets = {0, 0, 0};
  EXPECT_EQ(error_of(lattice, pyramids, {0}), "no error");
  EXPECT_EQ(error_of(lattice, pyramids, {1}), "no error");
  EXPECT_THAT(error_of(lattice, pyramids, {0, 1}), HasSubstr("1 and 2 which cross at an edge"));
}

TEST(Selection, SolutionsOutOfRangeAreAnError) {
  const auto lattice = make_lattice(2);
  EXPECT_THAT(error_of(lattice, lattice.cubes, {8}), HasSubstr("expected candidates from 1 to 8, found 9"));
  EXPECT_THAT(error_of(lattice, lattice.cubes, {2, 1}), HasSubstr("ascending"));
}

TEST(Selection, InvertedTetsAreAnError) {
  auto lattice = make_lattice(1);
  std::swap(lattice.mesh.tets[3][0], lattice.mesh.tets[3][1]);
  EXPECT_THAT(error_of(lattice, lattice.cubes, {}), HasSubstr("tet 4 flat or inverted"));
}

TEST(Selection, PrismsOfHalfACubeTakePart) {
  auto lattice = make_lattice(1);
  Candidates prisms;
  // The cube's diagonal plane x = y holds the edge 0-6 around which the six tets lie: three on each side.
  prisms.vertices.push_back({0, 4, 6, 1, 5, 7, -1, -1});
  prisms.kind.push_back(CellKind::prism);
  prisms.quality.push_back(0.7);
  prisms.volume.push_back(0.5);
  for (const auto t : indices<TetIndex>(6)) {
    Vec3 middle{};
    for (Vertex v : lattice.mesh.tets[t]) middle += lattice.mesh.points[v] * 0.25;
    if (middle.x > middle.y) prisms.tets.push_back(t);
  }
  ASSERT_EQ(prisms.tets.size(), 3u);
  prisms.tet_offsets.push_back(3);
  prisms.boundary_tet_offsets.push_back(0);
  const AssembleResult result = assemble::assemble(lattice.mesh, prisms, {0}, plain);
  EXPECT_EQ(result.mesh.prisms.size(), 1u);
  EXPECT_EQ(result.mesh.tets.size(), 3u);
  EXPECT_EQ(result.statistics.volumes.nonconforming_quads, 1);
  EXPECT_EQ(result.mesh.quads.size(), 2u);
}

}  // namespace
}  // namespace hexpipe
