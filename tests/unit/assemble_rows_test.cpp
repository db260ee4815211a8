// Rows of hexes that end inside a mesh, and rooms of any size between hexes.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/item_lists.hpp"
#include "common/mesh/quality.hpp"
#include "common/run/random.hpp"
#include "tools/assemble/gap/fewer_cells.hpp"
#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/passes.hpp"
#include "tools/assemble/gap/reshape.hpp"
#include "tools/assemble/gap/room_filling.hpp"
#include "tools/assemble/gap/solids.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe {
using namespace assemble;
using namespace assemble::gap;
namespace {

std::vector<Facet> facets_of(const Solid& solid) {
  std::vector<Facet> facets;
  for_facets(solid.kind, solid.vertices(), [&](const Facet& facet) { facets.push_back(facet); });
  return facets;
}

// What lies between two of the cells is not part of it.
std::vector<Facet> skin_of(std::span<const Solid> solids) {
  std::vector<Facet> skin;
  for (const Solid& solid : solids)
    for (const Facet& facet : facets_of(solid)) add_facet(facet, skin);
  return skin;
}

std::set<Vertex> vertices_of(const Solid& solid) {
  return {solid.vertices().begin(), solid.vertices().end()};
}

// A lattice of cubes whose rows at `row` end where i is as large as `end` says for a level k: the two vertices of such
// a row at each (i, k) with i <= end(k) are one. Where that leaves no hex or prism, and beside, stands a star.
struct EndedRow {
  static constexpr int nx = 6, ny = 4, nz = 6, row = 1;
  std::function<int(int)> end;
  TetMesh mesh;  // of tets around the middles of cells, which have numbers from first_middle on
  std::vector<Solid> chosen, rest;
  std::vector<Facet> room;
  Vertex middle = no_index;

  static Vertex vertex(int i, int j, int k) { return (i * (ny + 1) + j) * (nz + 1) + k; }
  bool has_ended(int i, int k) const { return i <= end(k); }
  Vertex mapped(int i, int j, int k) const { return vertex(i, j == row + 1 && has_ended(i, k) ? row : j, k); }

  explicit EndedRow(std::function<int(int)> end_of_level) : end(std::move(end_of_level)) {
    add_points();
    std::vector<std::pair<std::array<int, 3>, Solid>> cells;
    std::vector<std::array<int, 3>> open;
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < nz; ++k) {
          const std::vector<Facet> skin = skin_of_cell(i, j, k);
          if (skin.empty()) continue;
          if (const auto solid = solid_of(skin))
            cells.emplace_back(std::array{i, j, k}, *solid);
          else
            open.push_back({i, j, k});
        }
    // Where three of four edges have ended, two quads have three vertices in common: the cell above gives way.
    std::vector<std::array<int, 3>> gone = open;
    for (const auto& [i, j, k] : open)
      if (skin_of_cell(i, j, k).size() == 4) gone.push_back({i, j + 1, k});
    for (const auto& [at, solid] : cells)
      if (std::ranges::find(gone, at) == gone.end()) chosen.push_back(solid);
    for (const auto& [i, j, k] : gone)
      for (const Facet& facet : skin_of_cell(i, j, k)) add_facet(facet, room);
    if (!room.empty()) add_star();
    smooth();
    add_tets();
  }

  // Cells around the end of the row need room.
  void smooth() {
    MixedMesh cells;
    cells.points = mesh.points;
    std::vector<Solid> all = chosen;
    all.insert(all.end(), rest.begin(), rest.end());
    const auto append = [](auto& block, std::span<const Vertex> corners) {
      std::ranges::copy(corners, block.cells.emplace_back().begin());
      block.tags.push_back(1);
    };
    for (const Solid& solid : all) {
      if (solid.kind == CellKind::hex) append(cells.hexes, solid.vertices());
      if (solid.kind == CellKind::prism) append(cells.prisms, solid.vertices());
      if (solid.kind == CellKind::pyramid) append(cells.pyramids, solid.vertices());
      if (solid.kind == CellKind::tet) append(cells.tets, solid.vertices());
    }
    for (const Facet& facet : skin_of(all))
      if (facet.is_quad())
        append(cells.quads, facet.vertices());
      else
        append(cells.triangles, facet.vertices());
    shape::untangle(cells, 20);
    shape::smooth(cells, 5);
    mesh.points = cells.points;
  }

  void add_points() {
    for (int i = 0; i <= nx; ++i)
      for (int j = 0; j <= ny; ++j)
        for (int k = 0; k <= nz; ++k) {
          const double height = has_ended(i, k) ? (j - (j > row ? 1 : 0)) * double{ny} / (ny - 1) : j;
          mesh.points.push_back({1.0 * i, height, 1.0 * k});
        }
  }
  std::vector<Facet> skin_of_cell(int i, int j, int k) const {
    std::array<Vertex, 8> corners{};
    constexpr std::array<std::array<int, 2>, 4> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t c = 0; c < 8; ++c)
      corners[c] = mapped(i + around[c % 4][0], j + around[c % 4][1], k + (c < 4 ? 0 : 1));
    std::vector<Facet> skin;
    for (const auto& quad : HexTopology::quads) {
      std::vector<Vertex> left;
      for (const auto c : quad)
        if (std::ranges::find(left, corners[c]) == left.end()) left.push_back(corners[c]);
      if (left.size() < 3) continue;
      add_facet(Facet::of(left), skin);
    }
    return skin;
  }
  void add_star() {
    middle = static_cast<Vertex>(mesh.points.size());
    mesh.points.push_back(middle_of_star(mesh.points, room).at);
    for (const Facet& facet : room) {
      Solid solid{facet.is_quad() ? CellKind::pyramid : CellKind::tet, {}};
      const auto corners = facet.vertices();
      std::ranges::reverse_copy(corners, solid.corners.begin());
      solid.corners[corners.size()] = middle;
      rest.push_back(solid);
    }
  }
  // Tets for the surface: around the middle of each cell, along the diagonal from the least vertex of each quad.
  void add_tets() {
    for (const auto* solids : {&chosen, &rest})
      for (const Solid& solid : *solids) {
        Vec3 sum{};
        for (const Vertex v : solid.vertices()) sum += mesh.points[v];
        const auto centre = static_cast<Vertex>(mesh.points.size());
        mesh.points.push_back(sum * (1.0 / static_cast<double>(solid.vertices().size())));
        for (const Facet& facet : facets_of(solid))
          for (std::size_t i = 2; i < facet.vertices().size(); ++i)
            mesh.tets.push_back({facet.corners[0], facet.corners[i], facet.corners[i - 1], centre});
      }
    mesh.tet_tags.assign(mesh.tets.size(), 1);
    add_missing_boundary_triangles(mesh, TetAdjacency(mesh, "test"), 0);
  }

  hybrid::HybridMesh hybrid() const {
    hybrid::HybridMesh result(mesh, std::vector<bool>(mesh.tets.size(), true));
    const auto add = [&](const Solid& solid, CandidateIndex candidate) {
      if (solid.kind == CellKind::tet) {
        result.add_tet({solid.corners[0], solid.corners[1], solid.corners[2], solid.corners[3]}, 1);
        return;
      }
      hybrid::HybridCell cell;
      cell.kind = solid.kind, cell.corners = solid.corners, cell.region = 1, cell.candidate = candidate;
      result.add_cell(cell);
    };
    for (const Solid& solid : chosen) add(solid, CandidateIndex(0));
    for (const Solid& solid : rest) add(solid, no_index);
    return result;
  }
};

struct Counts {
  int hexes = 0, prisms = 0, others = 0;
  double volume = 0, least = 1;
  bool operator==(const Counts& other) const {
    return hexes == other.hexes && prisms == other.prisms && others == other.others &&
           std::abs(volume - other.volume) < 1e-9;
  }
};

Counts counts_of(const GapMesh& gap) {
  Counts counts;
  const auto add = [&](CellKind kind, std::span<const Vertex> corners) {
    ++(kind == CellKind::hex ? counts.hexes : kind == CellKind::prism ? counts.prisms : counts.others);
    counts.volume +=
        cell_volume(kind, std::span<const Vec3>(corner_points(gap.points(), corners)).first(corners.size()));
    counts.least = std::min(counts.least, quality_of(kind, gap.points(), corners));
  };
  for (const auto c : indices<GapIndex>(gap.cell_count()))
    if (gap.is_alive(c)) add(gap.cell(c).kind, gap.cell(c).vertices());
  for (const auto k : indices<KeptIndex>(gap.kept_count()))
    if (gap.kept_cell(k).is_alive) add(gap.kept_cell(k).kind, gap.kept_cell(k).vertices());
  return counts;
}

// A scene with what shorten_rows() needs.
struct Shortening {
  hybrid::HybridMesh hybrid;
  hybrid::SurfaceTags tags;
  shape::InputSurface input;

  explicit Shortening(const EndedRow& row)
      : hybrid(row.hybrid()), tags(row.mesh), input(row.mesh, TetAdjacency(row.mesh, "test")) {}
};

constexpr double box = EndedRow::nx * EndedRow::ny * EndedRow::nz;

TEST(Solid, IsToldFromItsFacetsInAnyOrder) {
  Random random(1);
  for (const CellKind kind : {CellKind::tet, CellKind::pyramid, CellKind::prism, CellKind::hex}) {
    Solid solid{kind, {}};
    const auto count = static_cast<std::size_t>(corner_count(kind));
    for (int run = 0; run < 50; ++run) {
      std::vector<Vertex> numbers(count);
      std::iota(numbers.begin(), numbers.end(), 5);
      random.shuffle(std::span(numbers));
      std::ranges::copy(numbers, solid.corners.begin());
      std::vector<Facet> facets = facets_of(solid);
      random.shuffle(std::span(facets));
      const auto found = solid_of(facets);
      ASSERT_TRUE(found);
      EXPECT_EQ(found->kind, kind);
      EXPECT_EQ(vertices_of(*found), vertices_of(solid));
      // Not inside out: each facet goes around as it did.
      for (const Facet& facet : facets_of(*found)) EXPECT_NE(std::ranges::find(facets, facet), facets.end());
      facets.back() = facets.back().reversed();
      EXPECT_FALSE(solid_of(facets));
      facets.pop_back();
      EXPECT_FALSE(solid_of(facets));
    }
  }
}

TEST(Solid, StandsOnAFacetWhoseSidesAreThereButOne) {
  const Solid hex{CellKind::hex, {0, 1, 2, 3, 4, 5, 6, 7}}, prism{CellKind::prism, {0, 1, 2, 3, 4, 5}};
  for (const Solid& solid : {hex, prism}) {
    const std::vector<Facet> facets = facets_of(solid);
    const auto stands = [&](std::vector<std::size_t> without) {
      std::vector<Facet> rest;
      for (std::size_t i = 0; i < facets.size(); ++i)
        if (std::ranges::find(without, i) == without.end()) rest.push_back(facets[i]);
      const auto found = solid_on(rest, facets[0]);
      return found && found->kind == solid.kind && vertices_of(*found) == vertices_of(solid);
    };
    EXPECT_TRUE(stands({}));
    EXPECT_TRUE(stands({1}));     // the facet opposite the base
    EXPECT_TRUE(stands({1, 2}));  // and a side
    EXPECT_FALSE(stands({1, 2, 3}));
  }
}

TEST(Solid, LeavesTheSkinOfTheRestOfTheRoom) {
  const Solid below{CellKind::hex, {0, 1, 2, 3, 4, 5, 6, 7}}, above{CellKind::hex, {4, 5, 6, 7, 8, 9, 10, 11}};
  const std::vector<Facet> skin = skin_of(std::array{below, above});
  const auto rest = skin_without(skin, below);
  ASSERT_TRUE(rest);
  const auto left = solid_of(*rest);
  ASSERT_TRUE(left);
  EXPECT_EQ(vertices_of(*left), vertices_of(above));
  // A cell on the outer side of a facet.
  const Solid beside{CellKind::hex, {8, 9, 10, 11, 12, 13, 14, 15}};
  EXPECT_FALSE(skin_without(skin, beside));
  EXPECT_EQ(bodies_of(skin).size(), 1u);
  EXPECT_EQ(bodies_of(skin_of(std::array{below, beside})).size(), 2u);
}

TEST(RoomFilling, HasAsFewCellsThatAreNoHexesAsItCan) {
  const EndedRow straight([](int) { return 2; });
  ASSERT_TRUE(straight.room.empty());
  hybrid::HybridMesh hybrid = straight.hybrid();
  const hybrid::SurfaceTags tags(straight.mesh);
  const GapMesh gap(hybrid, tags, {});
  const auto at = [&](int i, int j, int k) { return *solid_of(straight.skin_of_cell(i, j, k)); };
  // A prism of the column, the hex behind it and the one above that.
  const std::vector<Facet> skin =
      skin_of(std::array{at(2, EndedRow::row, 2), at(3, EndedRow::row, 2), at(3, EndedRow::row, 3)});
  const auto filling = fewest_cells(gap, skin, 5);
  ASSERT_TRUE(filling);
  EXPECT_EQ(filling->count, 1u);
  EXPECT_EQ(filling->cells.size(), 3u);
  EXPECT_TRUE(filling->stars.empty());
  EXPECT_FALSE(fewest_cells(gap, skin, 1));
}

TEST(RoomFilling, TakesAVertexInsideWhereNoCellFits) {
  const EndedRow jog([](int level) { return level <= 3 ? 2 : 3; });
  ASSERT_FALSE(jog.room.empty());
  hybrid::HybridMesh hybrid = jog.hybrid();
  const hybrid::SurfaceTags tags(jog.mesh);
  const GapMesh gap(hybrid, tags, {});
  const auto filling = fewest_cells(gap, jog.room, 100);
  ASSERT_TRUE(filling);
  EXPECT_EQ(filling->count, jog.room.size());
  ASSERT_EQ(filling->stars.size(), 1u);
  EXPECT_GT(middle_of_star(gap.points(), jog.room).worst, 0);
  EXPECT_FALSE(fewest_cells(gap, jog.room, jog.room.size()));
}

// The column of prisms moves over by a hex between two layers, and ten pyramids and two tets stand there.
TEST(ShortenRows, AColumnOfPrismsBecomesStraight) {
  const EndedRow jog([](int level) { return level <= 3 ? 2 : 3; });
  Shortening scene(jog);
  GapMesh gap(scene.hybrid, scene.tags, {});
  ASSERT_TRUE(gap.is_valid());
  const Counts before = counts_of(gap);
  EXPECT_EQ(before.hexes, 122);
  EXPECT_EQ(before.prisms, 5);
  EXPECT_EQ(before.others, 12);
  EXPECT_NEAR(before.volume, box, 1e-9);

  const ShortenCounts counts = shorten_rows(gap, scene.tags, scene.input);
  EXPECT_EQ(counts.rows, 1);
  EXPECT_EQ(counts.hexes, 2);
  const Counts after = counts_of(gap);
  EXPECT_EQ(after.hexes, 120);
  EXPECT_EQ(after.prisms, EndedRow::nz);
  EXPECT_EQ(after.others, 0);
  EXPECT_NEAR(after.volume, box, 1e-9);
  EXPECT_GE(after.least, least_hex_quality);

  gap.write_back();
  const GapMesh again(scene.hybrid, scene.tags, {});
  EXPECT_TRUE(again.is_valid());
  EXPECT_EQ(counts_of(again), after);
}

TEST(ShortenRows, AStraightColumnStays) {
  const EndedRow straight([](int) { return 2; });
  Shortening scene(straight);
  GapMesh gap(scene.hybrid, scene.tags, {});
  const Counts before = counts_of(gap);
  const ShortenCounts counts = shorten_rows(gap, scene.tags, scene.input);
  EXPECT_EQ(counts.rows + counts.pairs + counts.rooms, 0);
  EXPECT_EQ(counts_of(gap), before);
}

// Prisms side by side are no end of a row: whoever chose them keeps them.
TEST(ShortenRows, AFieldOfPrismsStays) {
  EndedRow full([](int) { return -1; });
  std::vector<Solid> halves;
  for (const Solid& hex : full.chosen) {
    const auto& c = hex.corners;
    halves.push_back({CellKind::prism, {c[0], c[1], c[2], c[4], c[5], c[6]}});
    halves.push_back({CellKind::prism, {c[0], c[2], c[3], c[4], c[6], c[7]}});
  }
  full.chosen = halves;
  full.mesh.points.resize(static_cast<std::size_t>(EndedRow::vertex(EndedRow::nx, EndedRow::ny, EndedRow::nz)) + 1);
  full.mesh.tets.clear(), full.mesh.triangles.clear(), full.mesh.triangle_tags.clear();
  full.add_tets();
  Shortening scene(full);
  GapMesh gap(scene.hybrid, scene.tags, {});
  const Counts before = counts_of(gap);
  EXPECT_EQ(before.prisms, 288);
  const ShortenCounts counts = shorten_rows(gap, scene.tags, scene.input);
  EXPECT_EQ(counts.rows + counts.pairs + counts.rooms, 0);
  EXPECT_EQ(counts_of(gap), before);
}

// Facets that are tagged inside of a room stay, so nothing is filled across them.
TEST(ShortenRows, ATaggedFacetInsideStays) {
  EndedRow jog([](int level) { return level <= 3 ? 2 : 3; });
  const Solid& cell = jog.rest.front();
  const auto facets = facets_of(cell);
  const Facet& inner = *std::ranges::find_if(facets, [&](const Facet& facet) { return facet.has(jog.middle); });
  jog.mesh.triangles.push_back({inner.corners[0], inner.corners[1], inner.corners[2]});
  jog.mesh.triangle_tags.push_back(7);
  Shortening scene(jog);
  GapMesh gap(scene.hybrid, scene.tags, {});
  const Counts before = counts_of(gap);
  shorten_rows(gap, scene.tags, scene.input);
  EXPECT_EQ(counts_of(gap), before);
}

// Chosen cells that several pieces have would have to go in all of them.
TEST(ShortenRows, PiecesOfAMeshKeepTheirRows) {
  const EndedRow jog([](int level) { return level <= 3 ? 2 : 3; });
  Shortening scene(jog);
  std::vector<std::uint8_t> is_shared(scene.hybrid.points.size());
  is_shared[EndedRow::vertex(EndedRow::nx, 0, 0)] = 1;
  const FewerCells counts =
      make_fewer_cells(scene.hybrid, {scene.tags, scene.input}, is_shared, Passes::merge_and_refill);
  EXPECT_EQ(counts.rows_shortened, 0);
  EXPECT_EQ(counts.hexes_gone, 0);
  Shortening whole(jog);
  EXPECT_EQ(make_fewer_cells(whole.hybrid, {whole.tags, whole.input}, {}, Passes::merge_and_refill).rows_shortened, 1);
}

// Six pyramids where a hex fits, which nobody had chosen.
TEST(ShortenRows, ARoomThatIsAHexBecomesOne) {
  EndedRow full([](int) { return -1; });
  const auto hole = std::ranges::find(full.chosen, vertices_of(*solid_of(full.skin_of_cell(2, 2, 2))), vertices_of);
  ASSERT_NE(hole, full.chosen.end());
  full.room = facets_of(*hole);
  full.chosen.erase(hole);
  full.mesh.points.resize(static_cast<std::size_t>(EndedRow::vertex(EndedRow::nx, EndedRow::ny, EndedRow::nz)) + 1);
  full.mesh.tets.clear(), full.mesh.triangles.clear(), full.mesh.triangle_tags.clear();
  full.add_star();
  full.add_tets();
  Shortening scene(full);
  GapMesh gap(scene.hybrid, scene.tags, {});
  EXPECT_EQ(counts_of(gap).others, 6);
  const ShortenCounts counts = shorten_rows(gap, scene.tags, scene.input);
  EXPECT_EQ(counts.rooms, 1);
  EXPECT_EQ(counts.hexes, -1);
  const Counts after = counts_of(gap);
  EXPECT_EQ(after.hexes, 144);
  EXPECT_EQ(after.others, 0);
  EXPECT_NEAR(after.volume, box, 1e-9);
  gap.write_back();
  EXPECT_EQ(counts_of(GapMesh(scene.hybrid, scene.tags, {})), after);
}

}  // namespace
}  // namespace hexpipe
