#include <gtest/gtest.h>

#include "assemble_lattice.hpp"
#include "tools/assemble/assemble.hpp"

namespace hexpipe {
using namespace assemble;
using namespace graph;
namespace {

using testing::jitter;
using testing::Lattice;
using testing::make_lattice;
using testing::random_choice;

// The lowest layer of a lattice of 2 x 2 x 2: cubes 0 to 3 at (0, 0), (0, 1), (1, 0), (1, 1).
Lattice one_layer() {
  const Lattice lattice = make_lattice(2);
  Lattice layer{2, lattice.mesh, {}};
  layer.mesh.tets.clear();
  layer.mesh.tet_tags.clear();
  for (const std::int32_t cube : {0, 2, 4, 6}) {
    const auto tets_before = static_cast<std::int32_t>(layer.mesh.tets.size());
    const std::int32_t first = lattice.cubes.interior_tets_of(cube).front();
    for (const TetIndex t : lattice.cubes.interior_tets_of(cube)) {
      layer.mesh.tets.push_back(lattice.mesh.tets[t]);
      layer.mesh.tet_tags.push_back(lattice.mesh.tet_tags[t]);
    }
    append_candidate(
        layer.cubes, lattice.cubes, cube, [](Vertex v) { return v; },
        [&](TetIndex t) { return TetIndex(t - first + tets_before); }, [](TetIndex t) { return t; });
  }
  return layer;
}

TEST(Fill, TwoPrismsStandInACornerBetweenCubes) {
  const Lattice layer = one_layer();
  for (std::int32_t missing = 0; missing < 4; ++missing) {
    SCOPED_TRACE(missing);
    IndependentSet chosen;
    for (std::int32_t cube = 0; cube < 4; ++cube)
      if (cube != missing) chosen.push_back(cube);
    const AssembleResult result = assemble::assemble(layer.mesh, layer.cubes, chosen, {.smooth = 0});
    EXPECT_EQ(result.statistics.filling_prisms, 2);
    EXPECT_EQ(result.mesh.hexes.size(), 3u);
    EXPECT_EQ(result.mesh.prisms.size(), 2u);
    EXPECT_EQ(result.mesh.pyramids.size(), 0u);
    EXPECT_EQ(result.mesh.tets.size(), 0u);
    EXPECT_EQ(result.statistics.volumes.nonconforming_quads, 0);

    const AssembleResult without =
        assemble::assemble(layer.mesh, layer.cubes, chosen, {.fill = AssembleOptions::Fill::none, .smooth = 0});
    EXPECT_EQ(without.statistics.filling_prisms, 0);
    EXPECT_EQ(without.mesh.prisms.size(), 0u);
    EXPECT_EQ(without.mesh.pyramids.size(), 2u);
  }
}

TEST(Fill, ACubeAloneStaysTets) {
  const auto lattice = make_lattice(1);
  const AssembleResult result = assemble::assemble(lattice.mesh, lattice.cubes, {}, {});
  EXPECT_EQ(result.mesh.prisms.size(), 0u);
  EXPECT_EQ(result.mesh.tets.size(), 6u);
}

TEST(Fill, TakesNothingWhereTheResultNeedNotConform) {
  const Lattice layer = one_layer();
  const AssembleResult result = assemble::assemble(layer.mesh, layer.cubes, {0, 1, 2},
                                                   {.conformity = AssembleOptions::Conformity::none, .smooth = 0});
  EXPECT_EQ(result.statistics.filling_prisms, 0);
  EXPECT_EQ(result.mesh.prisms.size(), 0u);
}

// Tets on the two sides of an interface become no prism together.
TEST(Fill, PrismsKeepToTheirRegion) {
  Lattice layer = one_layer();
  for (std::int32_t t = 18; t < 24; ++t) {
    Vec3 middle{};
    for (const Vertex v : layer.mesh.tets[t]) middle += layer.mesh.points[v] * 0.25;
    layer.mesh.tet_tags[t] = middle.z < 0.5 ? 1 : 2;
  }
  const AssembleResult result = assemble::assemble(layer.mesh, layer.cubes, {0, 1, 2}, {});
  EXPECT_EQ(result.mesh.prisms.size(), 0u);
  EXPECT_EQ(result.mesh.hexes.size(), 3u);
}

// Every result is checked by assemble itself; what is told apart here is that filling leaves fewer quads against tets,
// and that the chosen cells stand as they do without.
TEST(Fill, LeavesFewerQuadsAgainstTets) {
  std::int64_t open_with = 0, open_without = 0, prisms = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = make_lattice(4);
    jitter(lattice, 0.1, random);
    const auto chosen = random_choice(lattice, random.uniform(0.6, 0.95), random);
    const auto with = assemble::assemble(lattice.mesh, lattice.cubes, chosen, {.smooth = 0});
    const auto without =
        assemble::assemble(lattice.mesh, lattice.cubes, chosen, {.fill = AssembleOptions::Fill::none, .smooth = 0});
    EXPECT_LE(with.statistics.conformity.open_quads, without.statistics.conformity.open_quads);
    open_with += with.statistics.conformity.open_quads;
    open_without += without.statistics.conformity.open_quads;
    prisms += static_cast<std::int64_t>(with.mesh.prisms.size());
  }
  EXPECT_GT(prisms, 50);
  EXPECT_LT(open_with, open_without);
}

}  // namespace
}  // namespace hexpipe
