#include <gtest/gtest.h>

#include <vector>

#include "common/run/random.hpp"
#include "tools/assemble/gap/front.hpp"
#include "tools/assemble/gap/tried.hpp"

namespace hexpipe {
using namespace assemble;
using namespace assemble::gap;
namespace {

// What a room has as its front that these cells fill.
Front around(const std::vector<SmallCell>& cells) {
  Front front;
  for (const SmallCell& cell : cells)
    for_facets(cell, [&](SmallFacet facet) {
      if (const SmallFacet twin = facet.reversed(); front.has(twin)) {
        // The other cell's facet goes: put() takes whole cells, so the front is made anew without it.
        Front rest;
        for (const SmallFacet other : front.facets())
          if (other != twin) rest.add(other);
        front = rest;
      } else {
        front.add(facet);
      }
    });
  return front;
}

SmallCell tet(Corner a, Corner b, Corner c, Corner d) {
  return {CellKind::tet, {a, b, c, d}};
}

TEST(SmallFacet, BeginsWithTheLeastCornerAndTurnsRound) {
  EXPECT_EQ(SmallFacet::of(7, 2, 5), SmallFacet::of(2, 5, 7));
  EXPECT_NE(SmallFacet::of(7, 5, 2), SmallFacet::of(2, 5, 7));
  EXPECT_EQ(SmallFacet::of(7, 5, 2).reversed(), SmallFacet::of(2, 5, 7));
  EXPECT_EQ(SmallFacet::of({9, 11, 0, 4}), SmallFacet::of({0, 4, 9, 11}));
  EXPECT_EQ(SmallFacet::of({0, 4, 9, 11}).reversed(), SmallFacet::of({11, 9, 4, 0}));
  EXPECT_TRUE(SmallFacet::of({0, 4, 9, 11}).is_quad());
  EXPECT_FALSE(SmallFacet::of(0, 4, 9).is_quad());
}

TEST(Front, IsClosedByTheCellsThatItSurrounds) {
  const std::vector<SmallCell> cells{tet(0, 1, 2, 3), tet(1, 2, 3, 4), {CellKind::pyramid, {5, 6, 7, 8, 9}}};
  Front front = around(cells);
  EXPECT_EQ(front.facets().size(), 11u);
  EXPECT_TRUE(front.has_quads());
  for (const SmallCell& cell : cells) front.put(cell);
  EXPECT_TRUE(front.empty());
  EXPECT_FALSE(front.has_quads());
  EXPECT_FALSE(front.has(SmallFacet::of(0, 3, 2)));
}

// Tets that are glued facet to facet in a tree cannot be fewer; nor can bodies that do not touch.
TEST(Front, KnowsHowFewCellsFillATree) {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    const auto tets = static_cast<Corner>(1 + random.below(8));
    std::vector<SmallCell> cells{tet(0, 1, 2, 3)};
    for (Corner apex = 4; apex < 3 + tets; ++apex) {
      const Front front = around(cells);
      const SmallFacet base = front.facets()[random.below(front.facets().size())];
      cells.push_back(tet(base[0], base[1], base[2], apex));
    }
    EXPECT_EQ(around(cells).least_cells(), cells.size());
  }
  EXPECT_EQ(around({tet(0, 1, 2, 3), tet(4, 5, 6, 7), tet(8, 9, 10, 11)}).least_cells(), 3u);
  EXPECT_EQ(around({{CellKind::pyramid, {0, 1, 2, 3, 4}}}).least_cells(), 1u);
  EXPECT_EQ(around({{CellKind::prism, {0, 1, 2, 3, 4, 5}}}).least_cells(), 1u);
}

// Whatever tets are glued at random to a tet or a pyramid, the bound is not above their number.
TEST(Front, NeverAsksForMoreCellsThanThereAre) {
  Random random(6);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<SmallCell> cells{trial % 2 == 0 ? tet(0, 1, 2, 3) : SmallCell{CellKind::pyramid, {0, 1, 2, 3, 4}}};
    for (int more = 0; more < 8; ++more) {
      const Front front = around(cells);
      if (front.empty() || !front.has_room()) break;
      const SmallFacet base = front.facets()[random.below(front.facets().size())];
      const auto apex = static_cast<Corner>(random.below(most_corners));
      if (base.has(apex) || base.is_quad()) continue;
      const SmallCell next = tet(base[0], base[1], base[2], apex);
      bool fits = true;
      for_facets(next, [&](SmallFacet facet) { fits = fits && !front.has(facet); });
      if (fits) cells.push_back(next);
    }
    EXPECT_LE(around(cells).least_cells(), cells.size());
    const auto least = static_cast<double>(around(cells).least_cells());
    EXPECT_TRUE(around(cells).may_cost_less(2, 2.5 + least));
    EXPECT_FALSE(around(cells).may_cost_less(2, 2 + least));
  }
}

TEST(TriedRooms, AreKnownInAnyOrderUntilAVertexMovesOrACellComes) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {-1, -1, -1}};
  mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}, {0, 2, 1, 5}};
  mesh.tet_tags = {1, 1, 1};
  hybrid::HybridMesh hybrid(mesh, std::vector<bool>(3));
  const hybrid::SurfaceTags tags(TetMesh{});
  GapMesh gap(hybrid, tags, {});
  const GapIndex a(0), b(1), c(2);
  const std::vector<GapIndex> room{a, b}, turned{b, a}, other{a, c};
  const auto state = [&](const std::vector<GapIndex>& cells) { return TriedRooms::state_of(gap, cells); };
  const std::uint64_t first = state(room);
  EXPECT_EQ(first, state(turned));
  EXPECT_NE(first, state(other));
  gap.relocate(4, {1, 1, 1.1});
  const std::uint64_t moved = state(room);
  EXPECT_NE(first, moved);
  gap.replace(std::vector{c}, {});
  EXPECT_NE(moved, state(room)) << "a cell beside the room is gone";
}

}  // namespace
}  // namespace hexpipe
