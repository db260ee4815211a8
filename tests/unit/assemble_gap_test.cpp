#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "assemble_lattice.hpp"
#include "common/mesh/adjacency.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "tests/unit/list_of.hpp"
#include "tests/unit/random_cases.hpp"
#include "tools/assemble/assemble.hpp"
#include "tools/assemble/choice/selection.hpp"
#include "tools/assemble/conform/conform.hpp"
#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/fewer_cells.hpp"
#include "tools/assemble/gap/gap_mesh.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/passes.hpp"
#include "tools/assemble/gap/patch.hpp"
#include "tools/assemble/gap/refill.hpp"
#include "tools/assemble/gap/skin.hpp"

namespace hexpipe {
using namespace assemble;
using namespace assemble::gap;
using hybrid::HybridCell;
using hybrid::HybridMesh;
using hybrid::SurfaceTags;
using testing::list_of;
namespace {

// Tets around the last point, one on each triangle, and pyramids, one on each quad; all are listed as seen from inside.
struct Star {
  TetMesh mesh;
  std::vector<HybridCell> pyramids;

  Star(std::vector<Vec3> points, const std::vector<Triangle>& triangles, const std::vector<Quad>& quads) {
    mesh.points = std::move(points);
    const auto apex = static_cast<Vertex>(mesh.points.size() - 1);
    for (const auto& [a, b, c] : triangles) mesh.tets.push_back({a, b, c, apex});
    mesh.tet_tags.assign(mesh.tets.size(), 1);
    for (const auto& [a, b, c, d] : quads) {
      HybridCell pyramid;
      pyramid.kind = CellKind::pyramid;
      pyramid.corners = {a, b, c, d, apex, -1, -1, -1};
      pyramid.region = 1;
      pyramids.push_back(pyramid);
    }
  }

  HybridMesh hybrid() const {
    HybridMesh result(mesh, std::vector<bool>(mesh.tets.size()));
    for (const auto& pyramid : pyramids) result.add_cell(pyramid);
    return result;
  }
};

struct Census {
  std::map<CellKind, int> count;
  double volume = 0, worst = 1;
  bool valid = true;
  // By facet: how often it bounds a cell one way, less how often the other way. The skin is left.
  std::map<std::vector<Vertex>, int> uses;
  bool crowded = false;  // three cells or more at a facet

  void add(const HybridMesh& mesh, CellKind kind, std::span<const Vertex> corners, bool by_choice) {
    ++count[kind];
    const auto at = corner_points(mesh.points, corners);
    const auto cell = std::span<const Vec3>(at).first(corners.size());
    volume += cell_volume(kind, cell);
    valid = valid && is_valid(kind, cell);
    with_topology(kind, [&](auto topology) {
      auto each = [&](const auto& facets) {
        for (const auto& facet : facets) {
          std::vector<Vertex> key;
          for (const auto i : facet) key.push_back(corners[i]);
          std::ranges::sort(key);
          crowded = crowded || ++uses[key] > 2;
        }
      };
      each(decltype(topology)::triangles);
      each(decltype(topology)::quads);
    });
    if (by_choice) return;
    worst = std::min(worst, quality_of(kind, mesh.points, corners));
  }

  explicit Census(const HybridMesh& mesh) {
    for (const auto t : indices<TetIndex>(mesh.tet_count()))
      if (mesh.is_alive(t)) add(mesh, CellKind::tet, mesh.tet(t), false);
    for (const auto c : indices<CellIndex>(mesh.cell_count())) {
      const HybridCell& cell = mesh.cell(c);
      if (!cell.alive) continue;
      const std::span corners = std::span(cell.corners).first(static_cast<std::size_t>(corner_count(cell.kind)));
      add(mesh, cell.kind, corners, cell.candidate != no_index);
    }
  }

  std::set<std::vector<Vertex>> quads_of_skin() const {
    auto result = skin();
    std::erase_if(result, [](const auto& facet) { return facet.size() == 3; });
    return result;
  }

  bool has_half(const std::vector<Vertex>& triangle) const {
    return std::ranges::any_of(
        uses, [&](const auto& use) { return use.first.size() == 4 && std::ranges::includes(use.first, triangle); });
  }

  std::set<std::vector<Vertex>> skin() const {
    std::set<std::vector<Vertex>> result;
    for (const auto& [facet, times] : uses)
      if (times == 1) result.insert(facet);
    return result;
  }
};

// Whether the triangles of the skin are tagged, and the tagged triangles facets of cells or halves of the skin's quads.
bool has_tagged_skin(const Census& census, const SurfaceTags& tags) {
  std::set<std::vector<Vertex>> halves;
  for (const auto& facet : census.skin()) {
    if (facet.size() == 3 && !tags.contains({facet[0], facet[1], facet[2]})) return false;
    for (std::size_t i = 0; facet.size() == 4 && i < 4; ++i) {
      std::vector<Vertex> half = facet;
      half.erase(half.begin() + static_cast<std::ptrdiff_t>(i));
      halves.insert(half);
    }
  }
  for (const auto i : indices<hybrid::TaggedTriangle>(tags.size())) {
    if (tags.find(tags.triangle(i)) != i) continue;
    const auto key = key_of(tags.triangle(i));
    const std::vector<Vertex> triangle(key.begin(), key.end());
    // Interfaces may be quads inside, which the census does not tell from others.
    if (!census.uses.contains(triangle) && !halves.contains(triangle) && !census.has_half(triangle)) return false;
  }
  return true;
}

// A double pyramid over a square, and a point inside it.
Star octahedron(const Vec3& middle) {
  return {{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {0, 0, 1}, middle},
          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 5, 1}, {1, 5, 2}, {2, 5, 3}, {3, 5, 0}},
          {}};
}

// Around the middle of a prism, which has the corners of cell_topology.hpp: the quads listed become pyramids.
Star prism(std::size_t quads) {
  const std::vector<Quad> all{{0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
  std::vector<Triangle> triangles{{0, 1, 2}, {3, 5, 4}};
  for (std::size_t i = quads; i < 3; ++i)
    for (const auto& half : triangles_of(all[i], 0)) triangles.push_back(half);
  return {{{0, 0, 0}, {1, 0, 0}, {0.4, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0.4, 1, 1}, {0.45, 0.35, 0.5}},
          triangles,
          {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(quads)}};
}

// With no facet tagged: so that only what a test says is fixed.
SurfaceTags no_tags() {
  return SurfaceTags(TetMesh{});
}

TEST(MergeVertices, AVertexInsideGoesToANeighbour) {
  HybridMesh hybrid = octahedron({0.1, 0.05, 0}).hybrid();
  const Census before(hybrid);
  ASSERT_TRUE(before.valid);
  const SurfaceTags tags = no_tags();
  const std::vector<std::uint8_t> corners_stay{1, 1, 1, 1, 1, 1, 0};
  GapMesh gap(hybrid, tags, corners_stay);
  gap.ignore_faces();  // four cells with two neighbours each would cost more than eight with three
  EXPECT_TRUE(gap.is_free(6));
  EXPECT_FALSE(gap.is_free(0));
  EXPECT_EQ(merge_vertices(gap), 1);
  gap.write_back();
  const Census after(hybrid);
  EXPECT_EQ(after.count.at(CellKind::tet), 4);
  EXPECT_TRUE(after.valid);
  EXPECT_NEAR(after.volume, before.volume, 1e-12);
  EXPECT_EQ(after.skin(), before.skin());
}

TEST(MergeVertices, SharedVerticesAndThoseOnTaggedFacetsStay) {
  const Star star = octahedron({0.1, 0.05, 0});
  HybridMesh hybrid = star.hybrid();
  const SurfaceTags untagged = no_tags();
  const std::vector<std::uint8_t> all_stay(7, 1);
  GapMesh shared(hybrid, untagged, all_stay);
  EXPECT_EQ(merge_vertices(shared), 0);

  TetMesh with_triangle = star.mesh;
  with_triangle.triangles = {{0, 1, 6}};
  with_triangle.triangle_tags = {7};
  const SurfaceTags tags(with_triangle);
  const std::vector<std::uint8_t> corners_stay{1, 1, 1, 1, 1, 1, 0};
  GapMesh tagged(hybrid, tags, corners_stay);
  EXPECT_EQ(merge_vertices(tagged), 0);
}

TEST(MergeVertices, NoneGoesToTheCornerOfAQuad) {
  HybridMesh hybrid = prism(3).hybrid();
  ASSERT_TRUE(Census(hybrid).valid);
  const SurfaceTags tags = no_tags();
  const std::vector<std::uint8_t> corners_stay{1, 1, 1, 1, 1, 1, 0};
  GapMesh gap(hybrid, tags, corners_stay);
  EXPECT_EQ(merge_vertices(gap), 0);
  EXPECT_EQ(merge_stars(gap), 0);
}

std::vector<GapIndex> all_cells(const GapMesh& gap) {
  std::vector<GapIndex> cells;
  for (const auto c : indices<GapIndex>(gap.cell_count()))
    if (gap.is_alive(c)) cells.push_back(c);
  return cells;
}

TEST(Refill, PyramidsAroundAVertexBecomeAPrism) {
  HybridMesh hybrid = prism(3).hybrid();
  const SurfaceTags tags = no_tags();
  GapMesh gap(hybrid, tags, {});
  const auto in = Refill(gap).find(all_cells(gap));
  ASSERT_TRUE(in.has_value());
  ASSERT_EQ(in->size(), 1u);
  EXPECT_EQ(in->front().kind, CellKind::prism);
  gap.replace(all_cells(gap), *in);
  gap.write_back();
  const Census after(hybrid);
  EXPECT_TRUE(after.valid);
  EXPECT_EQ(after.skin(), Census(prism(3).hybrid()).skin());
  EXPECT_EQ(after.count.at(CellKind::prism), 1);
}

// The prism of valid Jacobian that gmshToFoam turns round, and an upright one.
TEST(GapMesh, APrismThatLooksInvertedIsWorthNothing) {
  TetMesh mesh;
  mesh.points = {{.1, .13859, .21934}, {.07927, .13784, .21934}, {.1, .13645, .23754},
                 {.1, .17926, .21308}, {.07681, .17868, .21538}, {.1, .17677, .21751}};
  HybridMesh warped(mesh, {});
  const SurfaceTags tags = no_tags();
  const std::array<Vertex, 6> corners{0, 1, 2, 3, 4, 5};
  EXPECT_GT(least_corner_scaled_jacobian(CellKind::prism, mesh.points), 0.12);
  EXPECT_LT(GapMesh(warped, tags, {}).make(CellKind::prism, corners, 0).quality, 0);
  HybridMesh upright = prism(3).hybrid();
  EXPECT_GT(GapMesh(upright, tags, {}).make(CellKind::prism, corners, 0).quality, 0.3);
}

TEST(Refill, TheFacetsOfTheRoomStay) {
  // Two triangles in place of one quad: no prism has them.
  HybridMesh hybrid = prism(2).hybrid();
  const SurfaceTags tags = no_tags();
  GapMesh gap(hybrid, tags, {});
  const auto cells = all_cells(gap);
  if (const auto in = Refill(gap).find(cells)) gap.replace(cells, *in);
  gap.write_back();
  const Census after(hybrid);
  EXPECT_EQ(after.skin(), Census(prism(2).hybrid()).skin());
  EXPECT_TRUE(after.valid);
}

// `n` tets around the edge between the first two points.
TetMesh ring_of_tets(int n) {
  TetMesh mesh;
  mesh.points = {{0, 0, -0.6}, {0, 0, 0.6}};
  for (int i = 0; i < n; ++i) mesh.points.push_back({std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n), 0});
  for (int i = 0; i < n; ++i) mesh.tets.push_back({0, 1, 2 + i, 2 + (i + 1) % n});
  mesh.tet_tags.assign(static_cast<std::size_t>(n), 1);
  return mesh;
}

TEST(Refill, ThreeTetsAtAnEdgeBecomeTwoUnlessAFacetIsTaggedOrARegionEnds) {
  const TetMesh mesh = ring_of_tets(3);
  const std::vector<bool> none_removed(3);
  const auto cells = list_of<GapIndex>({0, 1, 2});
  auto refilled = [&](const TetMesh& of) {
    HybridMesh hybrid(of, none_removed);
    const SurfaceTags tags(of);
    const GapMesh gap(hybrid, tags, {});
    const auto in = Refill(gap).find(cells);
    return in ? in->size() : 0;
  };
  EXPECT_EQ(refilled(mesh), 2u);
  TetMesh tagged = mesh;
  tagged.triangles = {{0, 1, 2}};
  tagged.triangle_tags = {3};
  EXPECT_EQ(refilled(tagged), 0u);
  TetMesh two_regions = mesh;
  two_regions.tet_tags[2] = 2;
  EXPECT_EQ(refilled(two_regions), 0u);
}

TEST(Refill, FindsNothingWhereEveryFillingIsWorse) {
  // Four tets at an edge can only become four others, which are no better.
  const TetMesh mesh = ring_of_tets(4);
  HybridMesh hybrid(mesh, std::vector<bool>(4));
  const SurfaceTags tags = no_tags();
  const GapMesh gap(hybrid, tags, {});
  EXPECT_FALSE(Refill(gap).find(list_of<GapIndex>({0, 1, 2, 3})).has_value());
}

TEST(MergeStars, TwoVerticesOnBothSidesOfAFacetBecomeOne) {
  // Two prisms with a triangle in common, each filled from its middle: no edge joins the two.
  TetMesh mesh;
  for (int level = 0; level < 3; ++level)
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.4, 1, 0}})
      mesh.points.push_back(p + Vec3{0, 0, 0.6 * level});
  mesh.points.push_back({0.45, 0.35, 0.3}), mesh.points.push_back({0.45, 0.35, 0.9});
  std::vector<HybridCell> pyramids;
  for (Vertex level = 0; level < 2; ++level) {
    const Vertex base = 3 * level, apex = 9 + level;
    mesh.tets.push_back({base, base + 1, base + 2, apex});
    mesh.tets.push_back({base + 3, base + 5, base + 4, apex});
    for (Vertex i = 0; i < 3; ++i) {
      const Vertex a = base + i, b = base + (i + 1) % 3;
      HybridCell pyramid;
      pyramid.kind = CellKind::pyramid;
      pyramid.corners = {a, a + 3, b + 3, b, apex, -1, -1, -1};
      pyramid.region = 1;
      pyramids.push_back(pyramid);
    }
  }
  mesh.tet_tags.assign(4, 1);
  HybridMesh hybrid(mesh, std::vector<bool>(4));
  for (const auto& pyramid : pyramids) hybrid.add_cell(pyramid);
  const Census before(hybrid);
  ASSERT_TRUE(before.valid);
  const SurfaceTags tags = no_tags();
  const std::vector<std::uint8_t> corners_stay{1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0};
  GapMesh gap(hybrid, tags, corners_stay);
  EXPECT_EQ(merge_vertices(gap), 0);
  EXPECT_EQ(merge_stars(gap), 1);
  gap.write_back();
  const Census after(hybrid);
  EXPECT_EQ(after.count.at(CellKind::tet), 2);
  EXPECT_EQ(after.count.at(CellKind::pyramid), 6);
  EXPECT_TRUE(after.valid);
  EXPECT_NEAR(after.volume, before.volume, 1e-12);
  EXPECT_EQ(after.skin(), before.skin());
}

// A lattice without hexes: every vertex but the eight corners may merge along the surface.
struct Block {
  TetMesh mesh;
  SurfaceTags tags;
  shape::InputSurface input;
  HybridMesh hybrid;

  static TetMesh mesh_of(int n, const std::function<void(Vec3&)>& shape) {
    TetMesh mesh = testing::make_lattice(n).mesh;
    for (Vec3& p : mesh.points) shape(p);
    add_missing_boundary_triangles(mesh, TetAdjacency(mesh, "test"), 0);
    return mesh;
  }
  explicit Block(
      int n, const std::function<void(Vec3&)>& shape = [](Vec3&) {})
      : mesh(mesh_of(n, shape)),
        tags(mesh),
        input(mesh, TetAdjacency(mesh, "test")),
        hybrid(mesh, std::vector<bool>(mesh.tets.size())) {}

  std::int64_t merge() {
    GapMesh gap(hybrid, tags, {});
    const std::int64_t merged = merge_on_surface(gap, tags, input);
    gap.write_back();
    return merged;
  }
  // By plane of the cube: the area of the tagged triangles in it.
  std::map<std::pair<int, double>, double> areas() const {
    std::map<std::pair<int, double>, double> result;
    for (const auto i : indices<hybrid::TaggedTriangle>(tags.size())) {
      const auto& [a, b, c] = tags.triangle(i);
      if (tags.find(tags.triangle(i)) != i) continue;
      const Vec3 p = hybrid.points[a], q = hybrid.points[b], r = hybrid.points[c];
      for (int axis = 0; axis < 3; ++axis)
        if (p[axis] == q[axis] && p[axis] == r[axis]) result[{axis, p[axis]}] += norm(cross(q - p, r - p)) / 2;
    }
    return result;
  }
};

TEST(MergeOnSurface, FlatSidesAndStraightEdgesLoseVerticesAndStayWhereTheyAre) {
  Block block(2);
  const auto areas = block.areas();
  ASSERT_EQ(areas.size(), 6u);
  EXPECT_GT(block.merge(), 4);
  const Census after(block.hybrid);
  EXPECT_TRUE(after.valid);
  EXPECT_NEAR(after.volume, 8, 1e-12);
  EXPECT_TRUE(has_tagged_skin(after, block.tags));
  for (const auto& [plane, area] : areas) EXPECT_NEAR(block.areas().at(plane), area, 1e-12);
  for (const int i : {0, 2})
    for (const int j : {0, 2})
      for (const int k : {0, 2}) {
        bool used = false;
        block.hybrid.for_tets_at(testing::lattice_vertex(2, i, j, k), [&](TetIndex) { used = true; });
        EXPECT_TRUE(used) << "corner " << i << j << k;
      }
}

// The middle of one side stands out.
TEST(MergeOnSurface, TheSurfaceStaysNearAndTheVolumeBetweenIsKnown) {
  const Vertex middle = testing::lattice_vertex(2, 1, 1, 2);
  auto is_there = [&](const Block& block) {
    bool used = false;
    block.hybrid.for_tets_at(middle, [&](TetIndex) { used = true; });
    return used;
  };
  for (const double height : {0.02, -0.02, 0.1}) {
    SCOPED_TRACE(height);
    Block block(2, [&](Vec3& p) { p.z += p == Vec3{1, 1, 2} ? height : 0; });
    const double before = Census(block.hybrid).volume;
    block.merge();
    const Census after(block.hybrid);
    EXPECT_TRUE(after.valid);
    EXPECT_EQ(is_there(block), height == 0.1);
    double off = 0;
    for (const Tet& tet : block.tags.peeled()) off += tet_determinant(block.hybrid.points, tet) / 6;
    EXPECT_NEAR(after.volume, before - off, 1e-12);
    EXPECT_NEAR(after.volume, 8, height == 0.1 ? 1 : 1e-12);
  }
}

TEST(MergeOnSurface, VerticesOfChosenCellsAndSharedOnesStay) {
  Block block(2);
  const std::vector<std::uint8_t> all_shared(block.mesh.points.size(), 1);
  GapMesh shared(block.hybrid, block.tags, all_shared);
  EXPECT_EQ(merge_on_surface(shared, block.tags, block.input), 0);
  // Where every cube is chosen nothing is left to merge.
  const auto lattice = testing::make_lattice(2);
  Random random(1);
  const auto all = testing::random_choice(lattice, 2, random);
  HybridMesh full = choice::Selection(block.mesh, block.tags, lattice.cubes, testing::candidates_in(all)).take_mesh();
  GapMesh gap(full, block.tags, {});
  EXPECT_EQ(merge_on_surface(gap, block.tags, block.input), 0);
}

// Tags by side of a cut through the top: the cut is a curve.
TEST(MergeOnSurface, ABorderOfTagsStaysWhereItIs) {
  TetMesh mesh = Block::mesh_of(2, [](Vec3&) {});
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const bool is_top = mesh.points[a].z == 2 && mesh.points[b].z == 2 && mesh.points[c].z == 2;
    mesh.triangle_tags[i] = is_top && mesh.points[a].x + mesh.points[b].x + mesh.points[c].x < 3 ? 8 : 7;
  }
  SurfaceTags tags(mesh);
  const shape::InputSurface input(mesh, TetAdjacency(mesh, "test"));
  HybridMesh hybrid(mesh, std::vector<bool>(mesh.tets.size()));
  GapMesh gap(hybrid, tags, {});
  EXPECT_GT(merge_on_surface(gap, tags, input), 0);
  double area = 0;
  for (const auto i : indices<hybrid::TaggedTriangle>(tags.size())) {
    if (tags.find(tags.triangle(i)) != i || tags.tag_of(i) != 8) continue;
    const auto& [a, b, c] = tags.triangle(i);
    for (const Vertex v : {a, b, c}) EXPECT_LE(hybrid.points[v].x, 1);
    area += norm(cross(hybrid.points[b] - hybrid.points[a], hybrid.points[c] - hybrid.points[a])) / 2;
  }
  EXPECT_NEAR(area, 2, 1e-12);
}

TEST(Room, NamesWhatLiesAroundItsCells) {
  HybridMesh hybrid = prism(3).hybrid();
  const SurfaceTags tags = no_tags();
  const GapMesh gap(hybrid, tags, {});
  const auto room = room_of(gap, all_cells(gap), 20);
  ASSERT_TRUE(room.has_value());
  EXPECT_EQ(room->skin.size(), 5u);
  EXPECT_EQ(room->vertices, (std::vector<Vertex>{0, 1, 2, 3, 4, 5}));
  EXPECT_FALSE(room_of(gap, all_cells(gap), 4).has_value()) << "more facets than allowed";
  const std::vector<std::uint8_t> middle_stays{0, 0, 0, 0, 0, 0, 1};
  EXPECT_FALSE(room_of(GapMesh(hybrid, tags, middle_stays), all_cells(gap), 20).has_value());
}

TEST(Objective, ACellCostsOneAndMoreWhereItIsPoor) {
  EXPECT_EQ(cost_of(1), 1);
  EXPECT_EQ(cost_of(0.5), 1);
  EXPECT_GT(cost_of(0.2), cost_of(0.3));
  EXPECT_NEAR(cost_of(0), 2, 1e-12);
}

TEST(Objective, AFaceCostsWhereItIsSkewOrOfLowWeight) {
  EXPECT_EQ(cost_of_face(std::cos(0.38 * M_PI), 0.06), 0);
  EXPECT_NEAR(cost_of_face(std::cos(80 * M_PI / 180), 0.5), 0.75, 1e-12);
  EXPECT_NEAR(cost_of_face(1, 0), 1, 1e-12);
  EXPECT_GT(cost_of_face(0.1, 0.01), cost_of_face(0.1, 0.5));
}

TEST(Objective, ACellCostsWhereItsFacesDoNotSpanSpace) {
  EXPECT_EQ(cost_of_span(0.001), 0);
  EXPECT_NEAR(cost_of_span(0.0005), 0.75, 1e-12);
  EXPECT_NEAR(cost_of_span(0), 1, 1e-12);
}

TEST(Objective, WhatSolversRefuseCostsSeveralCells) {
  EXPECT_EQ(cost_of_refused_span(0.001), 0);
  EXPECT_NEAR(cost_of_refused_span(0.0005), 1.5 * price_of_refusal, 1e-12);
  EXPECT_EQ(cost_of_refused_weight(0.05), 0);
  EXPECT_NEAR(cost_of_refused_weight(0), 2 * price_of_refusal, 1e-12);
  EXPECT_EQ(cost_of_refused_sight(0.01), 0);
  EXPECT_NEAR(cost_of_refused_sight(-0.5), 1.5 * price_of_refusal, 1e-12);
}

// Four tets around a point: with all of them in the mesh each has three neighbours, and a fourth side on the boundary.
TEST(FaceCosts, CountCellsThatHaveTooFewNeighbours) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25, 0.25, 0.25}};
  mesh.tets = {{0, 1, 2, 4}, {0, 3, 1, 4}, {0, 2, 3, 4}, {1, 3, 2, 4}};
  mesh.tet_tags = {1, 1, 1, 1};
  const SurfaceTags tags = no_tags();
  const auto all = list_of<GapIndex>({0, 1, 2, 3}), first = list_of<GapIndex>({0}), two = list_of<GapIndex>({0, 1});
  HybridMesh whole(mesh, std::vector<bool>(4));
  EXPECT_EQ(cost_of_faces(GapMesh(whole, tags, {}), all), 0);
  EXPECT_EQ(cost_of_faces(GapMesh(whole, tags, {}), first), 0) << "neighbours are found in the mesh";
  mesh.tets.resize(2), mesh.tet_tags.resize(2);
  HybridMesh half(mesh, std::vector<bool>(2));
  GapMesh gap(half, tags, {});
  EXPECT_NEAR(cost_of_faces(gap, two), 2, 1e-12) << "one neighbour each";
  EXPECT_FALSE(is_refused(gap, first.front()));
  gap.be_strict();
  EXPECT_NEAR(cost_of_faces(gap, two), 2 + 4 * price_of_refusal, 1e-12);
  EXPECT_TRUE(is_refused(gap, first.front()));
}

// A flat tet under a tall one: the line between their centres runs far off the normal of their face.
TEST(FaceCosts, CountEachFaceOnceAndWhatLiesBeyond) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-8, -8, 0.3}, {9, 9, -0.3}};
  mesh.tets = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  mesh.tet_tags = {1, 1};
  HybridMesh hybrid(mesh, std::vector<bool>(2));
  const SurfaceTags tags = no_tags();
  GapMesh gap(hybrid, tags, {});
  const auto both = list_of<GapIndex>({0, 1}), one = list_of<GapIndex>({0});
  const double cost = cost_of_faces(gap, both);
  EXPECT_GT(cost, 0.5);
  // With one neighbour a cell has no determinant, which costs 1.
  EXPECT_EQ(cost_of_faces(gap, one), cost - 1) << "the other cell is found in the mesh";
  gap.ignore_faces();
  EXPECT_EQ(cost_of_faces(gap, both), 0);
}

// A lattice with a part of its cubes chosen and made conforming.
struct ConformingScene {
  testing::Lattice lattice;
  SurfaceTags tags;
  shape::InputSurface input;
  HybridMesh hybrid;

  static testing::Lattice lattice_of(std::uint64_t seed, Random& random) {
    auto lattice = testing::make_lattice(3, [&](int i, int, int) { return seed % 3 == 0 && i > 0 ? 2 : 1; });
    testing::jitter(lattice, 0.05 * static_cast<double>(seed % 5), random);
    add_missing_boundary_triangles(lattice.mesh, TetAdjacency(lattice.mesh, "test"), 0);
    return lattice;
  }
  ConformingScene(std::uint64_t seed, Random random)
      : lattice(lattice_of(seed, random)),
        tags(lattice.mesh),
        input(lattice.mesh, TetAdjacency(lattice.mesh, "test")),
        hybrid(
            choice::Selection(lattice.mesh, tags, lattice.cubes,
                              testing::candidates_in(testing::random_choice(lattice, random.uniform(0.1, 0.9), random)))
                .take_mesh()) {
    conform::make_conforming(hybrid, tags, lattice.cubes, 1e-4);
  }
  // What is to fall.
  double objective(Passes passes) {
    const GapMesh gap(hybrid, tags, {});
    const auto cells = all_cells(gap);
    double sum = passes == Passes::merge ? 0 : cost_of_faces(gap, cells);
    for (const GapIndex c : cells) sum += cost_of(gap.cell(c).quality);
    return sum;
  }
  FewerCells make_fewer(Passes passes) { return make_fewer_cells(hybrid, {tags, input}, {}, passes); }
  double hex_volume() { return hex_volume_of(GapMesh(hybrid, tags, {})); }
};

// What is kept of each cell's faces says the same as faces that are judged together.
TEST(FaceCosts, OfCellsThatAreThereAreThoseOfTheSameCellsPlanned) {
  int costly = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    ConformingScene scene(seed, Random(seed));
    const GapMesh gap(scene.hybrid, scene.tags, {});
    for (Vertex v = 0; v < static_cast<Vertex>(gap.vertex_count()); ++v) {
      const auto cells = gap.cells_at(v);
      std::vector<GapCell> planned;
      for (const GapIndex c : cells) planned.push_back(gap.cell(c));
      const double cost = cost_of_faces(gap, cells);
      EXPECT_EQ(cost, cost_of_faces(gap, planned, cells));
      costly += cost > 0;
    }
  }
  EXPECT_GT(costly, 100);
}

TEST(FewerCells, NothingButTheCellsBetweenHexesChangesInThousandsOfMeshes) {
  std::int64_t changed = 0, merged_on_surface = 0, closed = 0;
  constexpr std::int64_t seeds = hexpipe::testing::random_cases(2000);
  for (std::int64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    ConformingScene scene(seed, Random(seed));
    const Census before(scene.hybrid);
    if (!before.valid) continue;
    constexpr std::array all_passes{Passes::merge, Passes::merge_and_refill, Passes::merge_and_refill, Passes::mend};
    const Passes passes = all_passes[seed % 4];
    const double cost_before = scene.objective(passes), hex_volume = scene.hex_volume();
    const auto counts = scene.make_fewer(passes);
    const double cost_after = scene.objective(passes);
    const Census after(scene.hybrid);
    ASSERT_TRUE(after.valid);
    ASSERT_FALSE(after.crowded);
    ASSERT_NEAR(after.volume, before.volume, 1e-10);
    const auto opened = static_cast<std::int64_t>(counts.opened.size());
    ASSERT_TRUE(counts.on_surface + counts.closed + opened > 0 || after.skin() == before.skin());
    ASSERT_TRUE(counts.closed + opened > 0 || after.quads_of_skin() == before.quads_of_skin());
    ASSERT_TRUE(has_tagged_skin(after, scene.tags));
    merged_on_surface += counts.on_surface > 0;
    closed += counts.closed;
    ASSERT_GE(after.worst, std::min(before.worst, least_quality) - 1e-12);
    // Hexes grow at the cost of other cells, until they have back what they lost.
    ASSERT_TRUE(counts.grown == 0 || (passes == Passes::mend && scene.hex_volume() < hex_volume + 1e-9));
    ASSERT_TRUE(opened + counts.grown > 0 || cost_after <= cost_before + 1e-9);
    ASSERT_TRUE(opened + counts.grown > 0 || cost_after < cost_before || !counts.any());
    const auto hexes = [](const Census& census) {
      const auto found = census.count.find(CellKind::hex);
      return found == census.count.end() ? 0 : found->second;
    };
    // A row that becomes shorter loses hexes, and a room may turn out to be one.
    ASSERT_EQ(hexes(after) + opened + counts.hexes_gone, hexes(before));
    ASSERT_TRUE(passes == Passes::merge_and_refill || counts.rows_shortened + counts.hexes_gone == 0);
    changed += counts.any();
  }
  EXPECT_GT(changed, seeds / 2);
  EXPECT_GT(merged_on_surface, seeds * 3 / 20);
  EXPECT_GT(closed, seeds / 200);
}

// Three tets around the edge from a to b, and one more on a facet at a: without the edge only that one is left, with b.
TEST(Refill, AsIfTwoVerticesWereOneLeavesWhatIsNotBetweenThem) {
  TetMesh mesh;
  mesh.points = {{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}, {0, 0, 0.4}, {0, 0, -0.1}, {0.6, 1, 1}};
  const Vertex a = 3, b = 4, beside = 5;
  mesh.tets = {{0, 1, a, b}, {1, 2, a, b}, {2, 0, a, b}, {0, 1, beside, a}};
  for (Tet& tet : mesh.tets)
    if (quality_of(CellKind::tet, mesh.points, tet) < 0) std::swap(tet[0], tet[1]);
  mesh.tet_tags.assign(4, 1);
  const SurfaceTags tags(mesh);
  HybridMesh hybrid(mesh, std::vector<bool>(4));
  const GapMesh gap(hybrid, tags, {});
  Refill refill(gap);
  const auto all = all_cells(gap);
  const auto between = refill.find_merged(std::span(all).first(3), a, b, 0.01, 10);
  ASSERT_TRUE(between);
  EXPECT_TRUE(between->empty());
  const auto left = refill.find_merged(all, a, b, 0.01, 10);
  ASSERT_TRUE(left);
  ASSERT_EQ(left->size(), 1u);
  EXPECT_TRUE(std::ranges::is_permutation(left->front().vertices(), std::array<Vertex, 4>{0, 1, b, beside}));
  EXPECT_FALSE(refill.find_merged(all, a, b, 0.99, 10));
}

TEST(FewerCells, WhereAGapClosesCellsAreFewerAndHexesStayGood) {
  const auto hexes_of = [](const GapMesh& gap) {
    std::pair<int, double> number_and_least{0, 1};
    for (const auto k : indices<KeptIndex>(gap.kept_count())) {
      const KeptCell& cell = gap.kept_cell(k);
      if (cell.kind != CellKind::hex) continue;
      ++number_and_least.first;
      number_and_least.second = std::min(number_and_least.second, quality_of(cell.kind, gap.points(), cell.vertices()));
    }
    return number_and_least;
  };
  std::int64_t closed_in_all = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    ConformingScene scene(seed, Random(seed));
    GapMesh gap(scene.hybrid, scene.tags, {});
    if (!gap.is_valid()) continue;
    const auto hexes = hexes_of(gap);
    const auto cells = all_cells(gap).size();
    const std::int64_t closed = close_gaps(gap, scene.tags, scene.input);
    if (closed == 0) continue;
    closed_in_all += closed;
    EXPECT_LT(all_cells(gap).size(), cells);
    EXPECT_EQ(hexes_of(gap).first, hexes.first);
    EXPECT_GE(hexes_of(gap).second, std::min(hexes.second, least_hex_quality));
    gap.write_back();
    const GapMesh again(scene.hybrid, scene.tags, {});
    EXPECT_TRUE(again.is_valid());
    EXPECT_EQ(hexes_of(again), hexes_of(gap));
    EXPECT_EQ(all_cells(again).size(), all_cells(gap).size());
    EXPECT_FALSE(Census(scene.hybrid).crowded);
  }
  EXPECT_GT(closed_in_all, 0);
}

// Vertices that several pieces of a mesh have stay, and so do chosen cells with such a vertex.
TEST(FewerCells, NoGapClosesBesideWhatSeveralPiecesHave) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    ConformingScene scene(seed, Random(seed));
    const std::vector<std::uint8_t> is_shared(scene.hybrid.points.size(), 1);
    GapMesh gap(scene.hybrid, scene.tags, is_shared);
    if (!gap.is_valid()) continue;
    EXPECT_EQ(close_gaps(gap, scene.tags, scene.input), 0);
  }
}

// Two layers of cubes, the lower one thin, less one of its cubes: what fills it is flat, and all its vertices but one
// are on the surface.
TEST(FewerCells, AHexGivesWayWhereACellBesideItStaysPoor) {
  const auto poor_cells = [](const GapMesh& gap) {
    return std::ranges::count_if(all_cells(gap), [&](GapIndex c) { return gap.cell(c).quality < least_wanted; });
  };
  for (const double thickness : {0.09, 0.1}) {
    SCOPED_TRACE(thickness);
    auto lattice = testing::make_lattice(2);
    for (Vec3& p : lattice.mesh.points)
      if (p.z == 1) p.z = thickness;
    add_missing_boundary_triangles(lattice.mesh, TetAdjacency(lattice.mesh, "test"), 0);
    const SurfaceTags tags(lattice.mesh);
    std::vector<CandidateIndex> chosen(lattice.cubes.size() - 1);
    std::iota(chosen.begin(), chosen.end(), CandidateIndex(1));
    HybridMesh hybrid = choice::Selection(lattice.mesh, tags, lattice.cubes, chosen, {}).take_mesh();
    conform::make_conforming(hybrid, tags, lattice.cubes, 1e-4);
    GapMesh gap(hybrid, tags, {});
    ASSERT_TRUE(gap.is_valid());
    mend(gap, false);
    const auto poor = poor_cells(gap);
    ASSERT_GT(poor, 0);
    const std::vector<CellIndex> opened = open_hexes(gap).chosen;
    ASSERT_EQ(opened.size(), 1u);
    EXPECT_LT(poor_cells(gap), poor);
    gap.write_back();
    EXPECT_FALSE(hybrid.cell(opened.front()).alive);
    const Census after(hybrid);
    EXPECT_TRUE(after.valid);
    EXPECT_FALSE(after.crowded);
    EXPECT_TRUE(has_tagged_skin(after, tags));
    EXPECT_NEAR(after.volume, 8, 1e-12);
  }
}

// Places of the first vertices, and the cells of the gap.
std::pair<std::vector<Vec3>, std::set<std::vector<Vertex>>> state_of(const GapMesh& gap, std::size_t vertices) {
  std::set<std::vector<Vertex>> cells;
  for (const GapIndex c : all_cells(gap)) cells.emplace(gap.cell(c).vertices().begin(), gap.cell(c).vertices().end());
  return {{gap.points().begin(), gap.points().begin() + static_cast<std::ptrdiff_t>(vertices)}, cells};
}

std::int64_t count_poor(const GapMesh& gap) {
  return std::ranges::count_if(all_cells(gap), [&](GapIndex c) { return gap.cell(c).quality < least_wanted; });
}

// A flat lattice with a part of its cubes chosen: many cells are poor.
struct FlatScene {
  testing::Lattice lattice;
  SurfaceTags tags;
  HybridMesh hybrid;

  static testing::Lattice lattice_of(double thickness, Random& random) {
    auto lattice = testing::make_lattice(2);
    testing::jitter(lattice, 0.2, random);
    for (Vec3& p : lattice.mesh.points) p.z *= thickness;
    testing::tag_boundary(lattice.mesh);
    return lattice;
  }
  FlatScene(double thickness, Random random)
      : lattice(lattice_of(thickness, random)),
        tags(lattice.mesh),
        hybrid(choice::Selection(lattice.mesh, tags, lattice.cubes,
                                 testing::candidates_in(testing::random_choice(lattice, 0.7, random)), {})
                   .take_mesh()) {
    conform::make_conforming(hybrid, tags, lattice.cubes, 1e-4);
  }
};

// What neither a new vertex in a small room nor a hex that gives way mends. If not all of it can be mended, nothing is.
TEST(OpenWide, LeavesNoPoorCellOrEverythingAsItWas) {
  int mended = 0, left = 0;
  for (const double thickness : {0.1, 0.15, 0.2})
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      SCOPED_TRACE(seed);
      FlatScene scene(thickness, Random(seed));
      const double volume = Census(scene.hybrid).volume;
      GapMesh gap(scene.hybrid, scene.tags, {});
      if (!gap.is_valid()) continue;
      for (int round = 0; round < 2; ++round) mend(gap, false), open_hexes(gap);
      if (count_poor(gap) == 0) continue;
      const std::size_t vertices = gap.vertex_count();
      const auto before = state_of(gap, vertices);
      const Opened opened = open_wide(gap);
      if (opened.inserted == 0) {
        EXPECT_EQ(state_of(gap, vertices), before);
        EXPECT_TRUE(opened.chosen.empty());
        ++left;
        continue;
      }
      EXPECT_EQ(count_poor(gap), 0);
      gap.write_back();
      for (const CellIndex c : opened.chosen) EXPECT_FALSE(scene.hybrid.cell(c).alive);
      const Census after(scene.hybrid);
      EXPECT_TRUE(after.valid);
      EXPECT_FALSE(after.crowded);
      EXPECT_NEAR(after.volume, volume, 1e-12);
      EXPECT_TRUE(has_tagged_skin(after, scene.tags));
      ++mended;
    }
  EXPECT_GT(mended, 0);
  EXPECT_GT(left, 0);
}

TEST(OpenWide, IsTheLastStepOfMending) {
  FlatScene scene(0.15, Random(6));
  GapMesh gap(scene.hybrid, scene.tags, {});
  ASSERT_TRUE(gap.is_valid());
  mend(gap, true);
  EXPECT_EQ(count_poor(gap), 0);
}

// A cell that cannot rise because those beside it are barely good enough rises with them.
TEST(Patch, APoorCellRisesWhereItsNeighboursYield) {
  int helped = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    ConformingScene scene(seed, Random(seed));
    const GapMesh gap(scene.hybrid, scene.tags, {});
    if (!gap.is_valid()) continue;
    Patch patch(gap);
    for (const GapIndex c : all_cells(gap)) {
      const std::vector<Vertex> vertices = gap.inner_vertices_around(c);
      if (gap.cell(c).quality >= least_quality || vertices.empty()) continue;
      patch.take(vertices, {});
      patch.raise(least_quality, 5);
      if (patch.least() >= least_quality && patch.keeps_floors() && patch.costs_at_most(patch.cost_before())) continue;
      patch.take(vertices, {});
      if (!patch.raise_with_neighbours(0.2, least_quality, 5)) continue;
      ++helped;
      EXPECT_GE(patch.least(), least_quality);
      EXPECT_TRUE(patch.keeps_floors());
      EXPECT_LE(patch.cost(), patch.cost_before());
    }
  }
  EXPECT_GT(helped, 0);
}

// Its way ends just before it is good enough if each step has to raise it much.
TEST(Patch, APoorCellRisesInSmallSteps) {
  ConformingScene scene(1679, Random(1679));
  const GapMesh gap(scene.hybrid, scene.tags, {});
  const GapIndex poor(84);
  ASSERT_LT(gap.cell(poor).quality, least_quality);
  Patch patch(gap);
  patch.take(gap.inner_vertices_around(poor), {});
  EXPECT_TRUE(patch.raise_with_neighbours(0.2, least_quality, 10));
}

std::int64_t count_refused(HybridMesh& mesh, const SurfaceTags& tags) {
  GapMesh gap(mesh, tags, {});
  gap.be_strict();
  return std::ranges::count_if(all_cells(gap), [&](GapIndex c) { return is_refused(gap, c); });
}

// Cubes at the edges of the lattice that are not chosen leave tets with two facets on the boundary.
TEST(MendRefused, OneVertexComesForSoManyChosenCells) {
  std::int64_t before_all = 0, after_all = 0, come = 0;
  for (const int n : {7, 8})
    for (const std::uint64_t seed : {1, 2, 3}) {
      SCOPED_TRACE(seed);
      Random random(seed);
      auto lattice = testing::make_lattice(n);
      testing::tag_boundary(lattice.mesh);
      SurfaceTags tags(lattice.mesh);
      const shape::InputSurface input(lattice.mesh, TetAdjacency(lattice.mesh, "test"));
      const auto chosen = testing::candidates_in(testing::random_choice(lattice, 0.7, random));
      HybridMesh hybrid = choice::Selection(lattice.mesh, tags, lattice.cubes, chosen, {}).take_mesh();
      conform::make_conforming(hybrid, tags, lattice.cubes, 1e-4);
      make_fewer_cells(hybrid, {tags, input}, {}, Passes::merge_and_refill);
      const auto old_points = static_cast<Vertex>(hybrid.points.size());
      before_all += count_refused(hybrid, tags);
      make_fewer_cells(hybrid, {tags, input}, {}, Passes::mend_refused);
      after_all += count_refused(hybrid, tags);
      std::set<Vertex> added;
      for (const auto& [facet, times] : Census(hybrid).uses)
        for (const Vertex v : facet)
          if (v >= old_points) added.insert(v);
      EXPECT_LE(added.size(), chosen.size() / 300) << n;
      come += static_cast<std::int64_t>(added.size());
    }
  EXPECT_GT(come, 0);
  EXPECT_LT(after_all, before_all);
}

TEST(MendRefused, NothingButTheCellsBetweenHexesChanges) {
  std::int64_t changed = 0, before_all = 0, after_all = 0;
  constexpr std::int64_t seeds = hexpipe::testing::random_cases(700);  // the first hundred leave 80 %
  for (std::int64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    ConformingScene scene(seed, Random(seed));
    scene.make_fewer(Passes::merge_and_refill);
    const Census before(scene.hybrid);
    if (!before.valid) continue;
    const auto refused = count_refused(scene.hybrid, scene.tags);
    const double hex_volume = scene.hex_volume();
    const auto counts = scene.make_fewer(Passes::mend_refused);
    const auto left = count_refused(scene.hybrid, scene.tags);
    const Census after(scene.hybrid);
    ASSERT_TRUE(after.valid);
    ASSERT_FALSE(after.crowded);
    ASSERT_NEAR(after.volume, before.volume, 1e-10);
    ASSERT_EQ(after.skin(), before.skin());
    ASSERT_TRUE(has_tagged_skin(after, scene.tags));
    ASSERT_GE(after.worst, std::min(before.worst, least_quality) - 1e-12);
    ASSERT_TRUE(counts.any() || left == refused);
    ASSERT_GE(scene.hex_volume(), hex_volume * (1 - 0.00021));
    EXPECT_EQ(counts.opened.size(), 0u);
    before_all += refused, after_all += left;
    changed += counts.any();
  }
  EXPECT_GT(changed, seeds / 3);
  EXPECT_LT(5 * after_all, 4 * before_all);
}

// The last step is all or nothing.
TEST(MendRefused, ChosenCellsGoOnlyIfNothingIsRefusedAfterwards) {
  int done = 0, undone = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    ConformingScene scene(seed, Random(seed));
    const Census before(scene.hybrid);
    if (!before.valid) continue;
    const auto refused = count_refused(scene.hybrid, scene.tags);
    const std::vector<Vec3> points = scene.hybrid.points;
    const auto counts = scene.make_fewer(Passes::open_for_refused);
    const Census after(scene.hybrid);
    EXPECT_TRUE(after.valid);
    EXPECT_FALSE(after.crowded);
    EXPECT_NEAR(after.volume, before.volume, 1e-10);
    EXPECT_GE(after.worst, std::min(before.worst, least_wanted) - 1e-12);
    if (counts.any()) {
      EXPECT_EQ(count_refused(scene.hybrid, scene.tags), 0);
      ++done;
      continue;
    }
    undone += refused > 0;
    EXPECT_TRUE(std::equal(points.begin(), points.end(), scene.hybrid.points.begin()));
    EXPECT_EQ(after.count, before.count);
  }
  EXPECT_GT(done, 3);
  EXPECT_GT(undone, 3);
}

TEST(GrowHexes, GrowUntilTheyHaveTheVolumeAskedFor) {
  constexpr double wanted = 0.03;
  int meshes = 0, reached = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    ConformingScene scene(seed, Random(seed));
    GapMesh gap(scene.hybrid, scene.tags, {});
    if (!gap.is_valid()) continue;
    std::vector<double> floors;
    for (const GapIndex c : all_cells(gap)) floors.push_back(std::min(gap.cell(c).quality, 0.2));
    const double before = hex_volume_of(gap);
    const std::int64_t moves = grow_hexes(gap, wanted);
    const double gained = hex_volume_of(gap) - before;
    EXPECT_EQ(moves > 0, gained > 0);
    EXPECT_LE(gained, wanted + 1e-12);
    std::size_t i = 0;
    for (const GapIndex c : all_cells(gap)) EXPECT_GE(gap.cell(c).quality, floors[i++] - 1e-12);
    ++meshes, reached += gained >= wanted;
    gap.write_back();
    const Census after(scene.hybrid);
    EXPECT_TRUE(after.valid);
    EXPECT_NEAR(after.volume, 27, 1e-10);
  }
  EXPECT_GT(reached, meshes / 3);
}

TEST(GrowHexes, LeavesThemWhenNothingIsWanted) {
  ConformingScene scene(3, Random(3));
  GapMesh gap(scene.hybrid, scene.tags, {});
  EXPECT_EQ(grow_hexes(gap, 0), 0);
}

// assemble checks its results itself: volumes have to add up over a surface that is not flat.
TEST(FewerCells, WhatMergesAlongACurvedSurfaceAddsUp) {
  std::int64_t merged = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = testing::make_lattice(3, [&](int i, int, int) { return seed % 3 == 0 && i > 0 ? 2 : 1; });
    const double bend = 0.01 * static_cast<double>(seed % 7);
    for (Vec3& p : lattice.mesh.points) p += Vec3{bend * p.y * p.z, bend * p.x * (3 - p.x), bend * p.y * p.y} * 0.5;
    const auto chosen = testing::random_choice(lattice, random.uniform(0.05, 0.6), random);
    const AssembleOptions options{.exchange = AssembleOptions::Exchange::none, .fill = AssembleOptions::Fill::none};
    const auto result = assemble::assemble(lattice.mesh, lattice.cubes, chosen, options);
    merged += result.statistics.improvement.fewer.on_surface;
  }
  EXPECT_GT(merged, 30);
}

TEST(FewerCells, LeavesAMeshWithInvertedCellsAlone) {
  ConformingScene valid(1, Random(1)), scene(1, Random(1));
  EXPECT_TRUE(valid.make_fewer(Passes::merge_and_refill).any());
  // A vertex inside that goes beyond its neighbours.
  scene.hybrid.points[testing::lattice_vertex(3, 1, 1, 1)] += Vec3{3, 0, 0};
  EXPECT_FALSE(scene.make_fewer(Passes::merge_and_refill).any());
}

TEST(FewerCells, AssembleMergesUnlessToldNotTo) {
  Random random(5);
  const auto lattice = testing::make_lattice(5);
  const auto chosen = testing::random_choice(lattice, 0.8, random);
  AssembleOptions options{.exchange = AssembleOptions::Exchange::none, .fill = AssembleOptions::Fill::none};
  const auto merged = assemble::assemble(lattice.mesh, lattice.cubes, chosen, options);
  options.merge = AssembleOptions::Merge::none;
  const auto plain = assemble::assemble(lattice.mesh, lattice.cubes, chosen, options);
  EXPECT_GT(merged.statistics.improvement.fewer.merged, 0);
  EXPECT_FALSE(plain.statistics.improvement.fewer.any());
  const auto& fewer = merged.statistics.improvement.fewer;
  EXPECT_EQ(static_cast<std::int64_t>(merged.mesh.hexes.size()) + fewer.hexes_gone,
            static_cast<std::int64_t>(plain.mesh.hexes.size()));
  EXPECT_LT(merged.mesh.tets.size(), plain.mesh.tets.size());
}

}  // namespace
}  // namespace hexpipe
