#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "formats/polyhedra/leaving_out.hpp"
#include "formats/polyhedra/mend_polyhedra.hpp"

namespace hexpipe::polyhedra {
namespace {

constexpr double tolerance = 1e-12;

struct Sample {
  PolyhedralMesh mesh;
  std::vector<LayerCell> cells;  // hexes and prisms

  // Cells that are no tets or pyramids come first.
  template <class Topology>
  void add(const std::array<Vertex, Topology::corner_count>& corners, std::int32_t region = 0) {
    const auto cell = static_cast<std::int32_t>(mesh.regions.size());
    mesh.regions.push_back(region);
    mesh.is_hex.push_back(Topology::kind == CellKind::hex ? 1 : 0);
    if (Topology::kind == CellKind::hex || Topology::kind == CellKind::prism) {
      cells.push_back({cell, Topology::kind, {}});
      std::ranges::copy(corners, cells.back().corners.begin());
    }
    const auto add_face = [&](const auto& local) {
      std::vector<Vertex> loop;
      for (const auto i : local) loop.push_back(corners[i]);
      std::vector<Vertex> key = loop;
      std::ranges::sort(key);
      const auto [found, is_new] = faces_.try_emplace(key, static_cast<std::int32_t>(mesh.faces.size()));
      if (is_new)
        mesh.add_face(loop, cell, no_index);
      else
        mesh.faces[found->second].neighbour = cell;
    };
    for (const auto& t : Topology::triangles) add_face(t);
    for (const auto& q : Topology::quads) add_face(q);
  }

 private:
  std::map<std::vector<Vertex>, std::int32_t> faces_;
};

// The points of nx x ny x nz unit cubes, and visit(the corners of a cube, its x) for each.
template <class Visit>
Sample lattice(int nx, int ny, int nz, Visit&& visit) {
  Sample sample;
  for (int z = 0; z <= nz; ++z)
    for (int y = 0; y <= ny; ++y)
      for (int x = 0; x <= nx; ++x) sample.mesh.points.push_back({1.0 * x, 1.0 * y, 1.0 * z});
  const auto at = [&](int x, int y, int z) { return Vertex((z * (ny + 1) + y) * (nx + 1) + x); };
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x)
        visit(sample,
              std::array{at(x, y, z), at(x + 1, y, z), at(x + 1, y + 1, z), at(x, y + 1, z), at(x, y, z + 1),
                         at(x + 1, y, z + 1), at(x + 1, y + 1, z + 1), at(x, y + 1, z + 1)},
              x);
  return sample;
}

Sample hexes(int nx, int ny, int nz) {
  return lattice(nx, ny, nz, [](Sample& sample, const auto& cube, int) { sample.add<HexTopology>(cube); });
}

// Six tets around the diagonal of each cube.
void add_tets(Sample& sample, const std::array<Vertex, 8>& cube, std::int32_t region) {
  constexpr std::array<std::array<int, 2>, 6> steps{{{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}};
  for (const auto& [a, b] : steps) sample.add<TetTopology>({cube[0], cube[a], cube[b], cube[6]}, region);
}

// Facets of the boundary get a surface for each of the six directions.
void tag_sides(PolyhedralMesh& mesh) {
  const MeasuredMesh measured(mesh);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    if (mesh.faces[i].is_inner()) continue;
    const Vec3 normal = measured.shape(static_cast<std::int32_t>(i)).area;
    int side = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(normal[axis]) > 0.1) side = 2 * axis + (normal[axis] > 0 ? 1 : 0);
    mesh.faces[i].surface = side;
  }
}

double volume_of_region(const MeasuredMesh& mesh, std::int32_t region) {
  double volume = 0;
  for (std::int32_t cell = 0; cell < static_cast<std::int32_t>(mesh.cell_count()); ++cell)
    if (mesh.mesh().regions[cell] == region) volume += mesh.volume(cell);
  return volume;
}

std::map<std::int32_t, Vec3> areas_of_surfaces(const MeasuredMesh& mesh) {
  std::map<std::int32_t, Vec3> areas;
  for (std::size_t i = 0; i < mesh.mesh().faces.size(); ++i) {
    const PolyhedralMesh::Face& face = mesh.mesh().faces[i];
    const Vec3 area = mesh.shape(static_cast<std::int32_t>(i)).area;
    if (face.surface != no_index) areas[face.surface] += face.flipped ? -area : area;
  }
  return areas;
}

// Cells are closed, faces have an owner before their neighbour, and no point is unused.
void expect_sound(const PolyhedralMesh& mesh) {
  std::vector<int> used(mesh.points.size());
  std::vector<std::map<std::pair<Vertex, Vertex>, int>> edges(mesh.regions.size());
  for (const PolyhedralMesh::Face& face : mesh.faces) {
    ASSERT_GE(face.owner, 0);
    const auto corners = mesh.corners_of(face);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      ++used[corners[i]];
      const Vertex a = corners[i], b = corners[(i + 1) % corners.size()];
      ++edges[face.owner][{a, b}];
      if (face.is_inner()) ++edges[face.neighbour][{b, a}];
    }
    if (face.is_inner()) {
      EXPECT_LT(face.owner, face.neighbour);
    }
  }
  EXPECT_EQ(std::ranges::count(used, 0), 0);
  for (const auto& cell : edges) {
    EXPECT_GE(cell.size(), 12U);
    for (const auto& [edge, count] : cell) {
      EXPECT_EQ(count, 1);
      EXPECT_TRUE(cell.contains({edge.second, edge.first}));
    }
  }
}

TEST(Polyhedra, NothingChangesWhereNothingIsWrong) {
  Sample sample = hexes(3, 3, 3);
  const PolyhedralMesh before = sample.mesh;
  const MendCounts counts = mend_polyhedra(sample.mesh, sample.cells);
  EXPECT_EQ(counts.refused_before, 0);
  EXPECT_FALSE(counts.changed());
  EXPECT_EQ(summary(counts), "");
  EXPECT_EQ(sample.mesh.corners, before.corners);
  EXPECT_EQ(sample.mesh.points, before.points);
  EXPECT_EQ(sample.mesh.faces.size(), before.faces.size());
}

TEST(Polyhedra, HexesOfASingleLayerAreHalved) {
  Sample sample = hexes(3, 3, 1);
  tag_sides(sample.mesh);
  const auto areas = areas_of_surfaces(MeasuredMesh(sample.mesh));
  const MendCounts counts = mend_polyhedra(sample.mesh, sample.cells);
  EXPECT_EQ(counts.refused_before, 9);
  EXPECT_EQ(counts.refused, 0);
  EXPECT_EQ(counts.halved, 9);
  EXPECT_EQ(counts.hexes, 1);
  expect_sound(sample.mesh);
  const MeasuredMesh after(sample.mesh);
  ASSERT_EQ(after.cell_count(), 18U);
  for (std::int32_t cell = 0; cell < 18; ++cell) {
    EXPECT_NEAR(after.volume(cell), 0.5, tolerance);
    EXPECT_EQ(after.faces_of(cell).size(), 6U);
    // Halves follow each other.
    EXPECT_NEAR(after.centre(cell).x, after.centre(cell / 2 * 2).x, tolerance);
  }
  // One in a corner has two sides of 1/2 and a middle of 1: by their mean 3/4, 3/4 and 3/2.
  EXPECT_EQ(after.refused().count(), 0U);
  for (const auto& [surface, area] : areas_of_surfaces(after))
    EXPECT_NEAR(norm(area - areas.at(surface)), 0, tolerance);
}

TEST(Polyhedra, ABarIsHalvedTwice) {
  Sample sample = hexes(4, 1, 1);
  const MendCounts counts = mend_polyhedra(sample.mesh, sample.cells);
  EXPECT_EQ(counts.halved, 12);  // four, and then eight
  EXPECT_EQ(counts.refused, 0);
  expect_sound(sample.mesh);
  EXPECT_EQ(sample.mesh.regions.size(), 16U);
}

// A cell beside a sheet gets two faces for one, with an angle between them.
TEST(Polyhedra, ACellAtTheEndOfASheetStaysConvex) {
  Sample sample = hexes(3, 3, 1);
  sample.mesh.points.push_back({3.6, 0.5, 0.5});
  sample.add<PyramidTopology>({3, 7, 23, 19, 32});
  const MeasuredMesh::Refused refused = MeasuredMesh(sample.mesh).refused();
  MeasuredMesh mesh(sample.mesh);
  EXPECT_EQ(split_single_layers(mesh, sample.cells, refused), 9);
  EXPECT_EQ(mesh.faces_of(9).size(), 6U);  // the base as two
  for (std::int32_t cell = 0; cell < static_cast<std::int32_t>(mesh.cell_count()); ++cell) {
    EXPECT_EQ(mesh.refusals_of_cell(cell) & concave, 0) << cell;
  }
  EXPECT_EQ(mesh.refusals_of_cell(9) & determinant, determinant);
  EXPECT_NEAR(volume_of_region(mesh, 0), 9.2, 1e-3);
}

TEST(Polyhedra, TetsWithTwoFacetsOnTheBoundaryMerge) {
  Sample sample = lattice(3, 3, 3, [](Sample& at, const auto& cube, int) { add_tets(at, cube, 0); });
  tag_sides(sample.mesh);
  const auto areas = areas_of_surfaces(MeasuredMesh(sample.mesh));
  const MendCounts counts = mend_polyhedra(sample.mesh, sample.cells);
  EXPECT_GT(counts.refused_before, 10);
  EXPECT_EQ(counts.refused, 0);
  EXPECT_GT(counts.merged, 0);
  EXPECT_LT(counts.polyhedra, counts.merged);
  expect_sound(sample.mesh);
  const MeasuredMesh after(sample.mesh);
  EXPECT_EQ(after.refused().count(), 0U);
  EXPECT_NEAR(volume_of_region(after, 0), 27, 1e-9);
  for (const auto& [surface, area] : areas_of_surfaces(after)) EXPECT_NEAR(norm(area - areas.at(surface)), 0, 1e-9);
}

TEST(Polyhedra, MendingEndsAtItsLimitOfWorkWithASoundMesh) {
  Sample sample = lattice(3, 3, 3, [](Sample& at, const auto& cube, int) { add_tets(at, cube, 0); });
  tag_sides(sample.mesh);
  const MendCounts counts = mend_polyhedra(sample.mesh, sample.cells, 100);
  EXPECT_TRUE(counts.ended_early);
  EXPECT_GT(counts.refused, 0);
  EXPECT_LT(counts.refused, counts.refused_before);
  EXPECT_THAT(summary(counts), ::testing::HasSubstr("; mending has ended at its limit of work"));
  expect_sound(sample.mesh);
  EXPECT_NEAR(volume_of_region(MeasuredMesh(sample.mesh), 0), 27, 1e-9);
}

TEST(Polyhedra, NothingCrossesTheBorderOfARegionOrAFacetInside) {
  Sample sample = lattice(4, 2, 2, [](Sample& at, const auto& cube, int x) { add_tets(at, cube, x / 2); });
  tag_sides(sample.mesh);
  constexpr std::int32_t border = 6, zone = 7;
  {
    const MeasuredMesh measured(sample.mesh);
    for (std::size_t i = 0; i < sample.mesh.faces.size(); ++i) {
      PolyhedralMesh::Face& face = sample.mesh.faces[i];
      const FaceShape& shape = measured.shape(static_cast<std::int32_t>(i));
      if (!face.is_inner() || std::abs(shape.area.x) < 0.4 || norm(shape.area) > 0.6) continue;
      if (shape.centre.x == 2) face.surface = border;
      if (shape.centre.x == 1) face.surface = zone;
      // Facets look towards x.
      face.flipped = face.surface >= border && shape.area.x < 0;
    }
  }
  const MendCounts counts = mend_polyhedra(sample.mesh, sample.cells);
  EXPECT_LT(counts.refused, counts.refused_before);
  EXPECT_GT(counts.merged, 0);
  expect_sound(sample.mesh);
  const MeasuredMesh after(sample.mesh);
  EXPECT_NEAR(volume_of_region(after, 0), 8, 1e-9);
  EXPECT_NEAR(volume_of_region(after, 1), 8, 1e-9);
  auto areas = areas_of_surfaces(after);
  for (const std::int32_t surface : {border, zone}) EXPECT_NEAR(norm(areas[surface] - Vec3{4, 0, 0}), 0, 1e-9);
  for (const PolyhedralMesh::Face& face : sample.mesh.faces) {
    if (!face.is_inner()) continue;
    EXPECT_EQ(face.surface == border, sample.mesh.regions[face.owner] != sample.mesh.regions[face.neighbour]);
  }
}

// A square with corners 0 to 3, of which 1 and 3 are lower. On top is a tet between both diagonals, with two facets on
// the boundary; two others stand below, on a tip.
Sample roof(double height) {
  Sample sample;
  sample.mesh.points = {{0, 0, 0}, {2, 0, -height}, {2, 2, 0}, {0, 2, -height}, {1, 1, -2}};
  sample.add<TetTopology>({0, 2, 1, 3});
  sample.add<TetTopology>({0, 3, 1, 4});
  sample.add<TetTopology>({1, 3, 2, 4});
  for (PolyhedralMesh::Face& face : sample.mesh.faces)
    if (!face.is_inner()) face.surface = 0;
  return sample;
}

std::vector<std::vector<Vertex>> sorted_facets(const PolyhedralMesh& mesh) {
  std::vector<std::vector<Vertex>> facets;
  for (const PolyhedralMesh::Face& face : mesh.faces) {
    if (face.owner == no_index || face.is_inner()) continue;
    facets.emplace_back(mesh.corners_of(face).begin(), mesh.corners_of(face).end());
    std::ranges::sort(facets.back());
  }
  std::ranges::sort(facets);
  return facets;
}

TEST(Polyhedra, AFlatTetIsLeftOutAndItsEdgeFlipped) {
  constexpr double height = 0.03;
  Sample sample = roof(height);
  MeasuredMesh mesh(sample.mesh);
  const double volume = volume_of_region(mesh, 0);
  // Two edges of 2 sqrt(2), across each other at this distance.
  EXPECT_NEAR(mesh.volume(0), 8 * height / 6, tolerance);
  EXPECT_EQ(mesh.refusals_of_cell(0) & determinant, determinant);
  ASSERT_TRUE(cost_of_leaving_out(mesh, 0));
  EXPECT_EQ(mesh.faces_of(0).size(), 4U);  // it is taken back
  ASSERT_TRUE(leave_out(mesh, 0));
  renumber(sample.mesh, mesh.order());
  expect_sound(sample.mesh);
  const MeasuredMesh after(sample.mesh);
  EXPECT_EQ(after.cell_count(), 2U);
  EXPECT_NEAR(volume_of_region(after, 0), volume - 8 * height / 6, tolerance);
  const std::vector<std::vector<Vertex>> expected{{0, 1, 3}, {0, 1, 4}, {0, 3, 4}, {1, 2, 3}, {1, 2, 4}, {2, 3, 4}};
  EXPECT_EQ(sorted_facets(sample.mesh), expected);
  for (const PolyhedralMesh::Face& face : sample.mesh.faces) {
    EXPECT_EQ(face.surface, face.is_inner() ? no_index : 0);
    EXPECT_FALSE(face.flipped);
  }
  // Facets look outward, and close.
  EXPECT_NEAR(norm(areas_of_surfaces(after)[0]), 0, tolerance);
}

TEST(Polyhedra, ATetWithThreeFacetsIsLeftOutWithItsVertex) {
  Sample sample;
  sample.mesh.points = {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, 0.7, 0.1}, {1, 0.7, -2}};
  sample.add<TetTopology>({0, 1, 2, 3});
  sample.add<TetTopology>({0, 2, 1, 4});
  for (PolyhedralMesh::Face& face : sample.mesh.faces)
    if (!face.is_inner()) face.surface = face.owner;
  MeasuredMesh mesh(sample.mesh);
  // The one behind would have no neighbour.
  EXPECT_FALSE(cost_of_leaving_out(mesh, 0));
  sample.mesh.points.push_back({-2, 1, -1});
  sample.add<TetTopology>({0, 2, 4, 5});
  for (PolyhedralMesh::Face& face : sample.mesh.faces)
    if (!face.is_inner()) face.surface = face.owner;
  MeasuredMesh more(sample.mesh);
  ASSERT_TRUE(cost_of_leaving_out(more, 0));
  ASSERT_TRUE(leave_out(more, 0));
  renumber(sample.mesh, more.order());
  expect_sound(sample.mesh);
  EXPECT_EQ(sample.mesh.points.size(), 5U);
  for (const Vec3& p : sample.mesh.points) EXPECT_LE(p.z, 0);
  EXPECT_NEAR(norm(areas_of_surfaces(MeasuredMesh(sample.mesh))[0] - Vec3{0, 0, 2}), 0, tolerance);
}

TEST(Polyhedra, ACellStaysWhereTheBoundaryWouldChange) {
  const auto is_kept = [](Sample sample) {
    MeasuredMesh mesh(sample.mesh);
    return !cost_of_leaving_out(mesh, 0);
  };
  EXPECT_FALSE(is_kept(roof(0.03)));
  // The distance of the diagonals by the length of an edge, 2: above 0.2 from 0.4 on, where facets turn by 32 degrees.
  EXPECT_FALSE(is_kept(roof(0.39)));
  EXPECT_TRUE(is_kept(roof(0.42)));
  // Two surfaces.
  Sample two = roof(0.03);
  for (PolyhedralMesh::Face& face : two.mesh.faces)
    if (face.owner == 0 && !face.is_inner()) face.surface = static_cast<std::int32_t>(&face - two.mesh.faces.data());
  EXPECT_TRUE(is_kept(two));
  // Two regions.
  Sample regions = roof(0.03);
  regions.mesh.regions[1] = 1;
  EXPECT_TRUE(is_kept(regions));
  // The edge that would come has two facets already, below.
  Sample layer;
  layer.mesh.points = {{0, 0, 0.03}, {2, 0, 0},  {2, 2, 0.03},  {0, 2, 0},
                       {0, 0, -1},   {2, 2, -1}, {1, -2, -0.5}, {4, 1, -0.5}};
  layer.add<TetTopology>({0, 2, 1, 3});
  layer.add<TetTopology>({0, 3, 1, 4});
  layer.add<TetTopology>({1, 3, 2, 5});
  // Each has another neighbour.
  layer.add<TetTopology>({0, 4, 1, 6});
  layer.add<TetTopology>({1, 5, 2, 7});
  for (PolyhedralMesh::Face& face : layer.mesh.faces)
    if (!face.is_inner()) face.surface = 0;
  EXPECT_TRUE(is_kept(layer));
}

TEST(Polyhedra, AChangeThatIsTakenBackLeavesNothing) {
  Sample sample = lattice(2, 2, 2, [](Sample& at, const auto& cube, int) { add_tets(at, cube, 0); });
  const std::vector<Vertex> corners = sample.mesh.corners;
  const std::vector<Vec3> points = sample.mesh.points;
  MeasuredMesh mesh(sample.mesh);
  const std::vector<std::int32_t> refused = mesh.refused().cells;
  ASSERT_FALSE(refused.empty());
  const Vec3 centre = mesh.centre(refused[0]);
  {
    MeasuredMesh::Undo undo(mesh, refused);
    mesh.add_point({});
    const std::int32_t face = mesh.faces_of(refused[0])[0];
    mesh.set_loop(face, std::vector<Vertex>{0, 1, 2, 3});
    mesh.measure_face(face);
    mesh.measure_cell(refused[0]);
    mesh.add_cell_after(refused[0]);
    undo.take_back();
  }
  EXPECT_EQ(sample.mesh.corners, corners);
  EXPECT_EQ(sample.mesh.points, points);
  EXPECT_EQ(mesh.centre(refused[0]), centre);
  EXPECT_EQ(mesh.refused().cells, refused);
  EXPECT_EQ(mesh.cell_count(), 48U);
}

}  // namespace
}  // namespace hexpipe::polyhedra
