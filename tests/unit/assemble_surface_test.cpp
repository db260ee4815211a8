#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "assemble_lattice.hpp"
#include "common/mesh/adjacency.hpp"
#include "tools/assemble/assemble.hpp"
#include "tools/assemble/shape/boundary_deviation.hpp"
#include "tools/assemble/shape/input_surface.hpp"
#include "tools/assemble/shape/nearest_points.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe {
using namespace assemble;
using namespace assemble::shape;
using namespace graph;
namespace {

using testing::lattice_vertex;
using testing::make_lattice;
using testing::tag_boundary;
using Place = InputSurface::Place;

// A round column: the lattice with its squares mapped to discs of radius 1, all around at one distance from the axis.
testing::Lattice make_column(int n) {
  auto lattice = make_lattice(n);
  for (auto& p : lattice.mesh.points) {
    const double x = 2 * p.x / n - 1, y = 2 * p.y / n - 1, height = 2 * p.z / n;
    p = {x * std::sqrt(1 - y * y / 2), y * std::sqrt(1 - x * x / 2), height};
  }
  tag_boundary(lattice.mesh);
  return lattice;
}

TEST(InputSurface, TellsSidesEdgesAndCornersOfABox) {
  auto lattice = make_lattice(3);
  tag_boundary(lattice.mesh);
  const InputSurface surface(lattice.mesh, TetAdjacency(lattice.mesh, "mesh"));
  std::array<int, 4> found{};
  for (std::size_t v = 0; v < lattice.mesh.points.size(); ++v)
    ++found[static_cast<int>(surface.place(static_cast<Vertex>(v)))];
  EXPECT_EQ(found, (std::array{8, 24, 24, 8}));
}

// A box stands with the middle of its underside on the middle of the other's top, and shares no more than this vertex.
TEST(InputSurface, WhereTwoSheetsTouchIsACorner) {
  auto lattice = make_lattice(2);
  TetMesh& mesh = lattice.mesh;
  const Vertex top = lattice_vertex(2, 1, 1, 2), under = lattice_vertex(2, 1, 1, 0);
  const auto count = static_cast<Vertex>(mesh.points.size());
  const std::vector<Vec3> points = mesh.points;
  for (const Vec3& p : points) mesh.points.push_back(p + Vec3{0, 0, 2});
  const std::vector<Tet> tets = mesh.tets;
  for (Tet tet : tets) {
    for (Vertex& v : tet) v = v == under ? top : v + count;
    mesh.tets.push_back(tet);
    mesh.tet_tags.push_back(1);
  }
  tag_boundary(mesh);
  const InputSurface surface(mesh, TetAdjacency(mesh, "mesh"));
  EXPECT_EQ(surface.place(top), Place::corner);
  EXPECT_EQ(surface.place(under), Place::face);
}

TEST(InputSurface, BordersOfTagsAreFeatures) {
  auto lattice = make_lattice(4);
  TetMesh& mesh = lattice.mesh;
  tag_boundary(mesh);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (Vertex v : mesh.triangles[i])
      if (mesh.points[v].x < 2) mesh.triangle_tags[i] = 3;
  const InputSurface surface(mesh, TetAdjacency(mesh, "mesh"));
  EXPECT_EQ(surface.place(lattice_vertex(4, 2, 2, 0)), Place::curve);
  EXPECT_EQ(surface.place(lattice_vertex(4, 2, 0, 0)), Place::corner);
  EXPECT_EQ(surface.place(lattice_vertex(4, 3, 2, 0)), Place::face);
}

// A plate a fifth of an edge thick, and one of two sheets that are half of it.
TEST(InputSurface, FacetsStayNearerWhereThePartIsThinnerThanAnEdge) {
  constexpr int n = 4;
  const Vertex middle = lattice_vertex(n, 2, 2, n);
  auto block = make_lattice(n);
  tag_boundary(block.mesh);
  EXPECT_NEAR(InputSurface(block.mesh, TetAdjacency(block.mesh, "mesh")).most_deviation_at(middle),
              most_deviation * (2 + std::sqrt(2)) / 3, 1e-12);
  for (const bool sheets : {false, true}) {
    auto plate = make_lattice(n, [&](int, int, int k) { return sheets && k >= n / 2 ? 2 : 1; });
    for (auto& p : plate.mesh.points) p.z *= 0.2 / n;
    tag_boundary(plate.mesh);
    const InputSurface surface(plate.mesh, TetAdjacency(plate.mesh, "mesh"));
    EXPECT_NEAR(surface.most_deviation_at(middle), most_deviation * (sheets ? 0.1 : 0.2), 1e-12);
    EXPECT_NEAR(surface.most_deviation_at(lattice_vertex(n, 2, 2, 0)), surface.most_deviation_at(middle), 1e-12);
    if (sheets) {
      EXPECT_NEAR(surface.most_deviation_at(lattice_vertex(n, 2, 2, 2)), most_deviation * 0.1, 1e-12);
    }
  }
}

// As in tetmesh, which lays no curve along a weaker bend.
TEST(InputSurface, BendsOfFortyDegreesAreFeatures) {
  for (double degrees : {35.0, 45.0}) {
    auto lattice = make_lattice(4);
    // Beyond the middle, the block leans.
    for (auto& p : lattice.mesh.points) p.z -= std::max(0.0, p.x - 2) * std::tan(degrees * M_PI / 180);
    tag_boundary(lattice.mesh);
    EXPECT_EQ(InputSurface(lattice.mesh, TetAdjacency(lattice.mesh, "mesh")).place(lattice_vertex(4, 2, 2, 4)),
              degrees < 40 ? Place::face : Place::curve);
  }
}

TEST(InputSurface, FindsFeetOnItsOwnPart) {
  auto lattice = make_lattice(3);
  tag_boundary(lattice.mesh);
  const InputSurface surface(lattice.mesh, TetAdjacency(lattice.mesh, "mesh"));
  const Vec3 to{2.9, 2.2, 0.5};
  const auto on_face = surface.foot(lattice_vertex(3, 1, 1, 0), to);
  EXPECT_NEAR(norm(on_face.at - Vec3{2.9, 2.2, 0}), 0, 1e-12);
  EXPECT_NEAR(std::abs(on_face.axis.z), 1, 1e-12);
  const auto on_curve = surface.foot(lattice_vertex(3, 1, 0, 0), to);
  EXPECT_NEAR(norm(on_curve.at - Vec3{2.9, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(std::abs(on_curve.axis.x), 1, 1e-12);
  EXPECT_EQ(surface.foot(lattice_vertex(3, 0, 0, 0), to).at, (Vec3{0, 0, 0}));
  // Past the end of the curve: its end.
  EXPECT_NEAR(norm(surface.foot(lattice_vertex(3, 1, 0, 0), {9, 1, 1}).at - Vec3{3, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(surface.distance(lattice_vertex(3, 1, 1, 0), to), 0.1, 1e-12) << "across features";
  EXPECT_NEAR(surface.distance(to), 0.1, 1e-12);
}

TEST(InputSurface, TheNearestPointOfATriangleIsTheNearestOfMany) {
  Random random(9);
  auto point = [&] { return Vec3{random.uniform(), random.uniform(), random.uniform()}; };
  for (int trial = 0; trial < 200; ++trial) {
    const std::array<Vec3, 3> triangle{point(), point(), trial % 10 == 0 ? Vec3{} : point()};
    const Vec3 to = 2 * point() - Vec3{0.5, 0.5, 0.5};
    const double found = norm(nearest_on_triangle(triangle, to) - to);
    double least = 10;
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; i + j <= 60; ++j) {
        const double a = i / 60.0, b = j / 60.0;
        least = std::min(least, norm(triangle[0] * a + triangle[1] * b + triangle[2] * (1 - a - b) - to));
      }
    EXPECT_LE(found, least + 1e-12);
    EXPECT_GT(found, least - 0.05);
  }
}

TEST(InputSurface, ATriangleIsSurelyFartherOnlyIfItIs) {
  Random random(10);
  auto point = [&] { return Vec3{random.uniform(), random.uniform(), random.uniform()}; };
  int farther = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::array<Vec3, 3> triangle{point(), point(), trial % 10 == 0 ? Vec3{} : point()};
    const Vec3 to = 2 * point() - Vec3{0.5, 0.5, 0.5};
    const double found = norm_squared(nearest_on_triangle(triangle, to) - to);
    EXPECT_FALSE(is_surely_farther(triangle, to, found)) << "as near as its nearest point";
    farther += is_surely_farther(triangle, to, 0.5 * found);
    EXPECT_FALSE(is_surely_farther(triangle, triangle[1], 0));
  }
  EXPECT_GT(farther, 500);
}

TEST(BoundaryDeviation, SeesWhatMoved) {
  auto lattice = make_lattice(2);
  tag_boundary(lattice.mesh);
  const InputSurface surface(lattice.mesh, TetAdjacency(lattice.mesh, "mesh"));
  MixedMesh mesh = to_mixed_mesh(lattice.mesh);
  std::vector<Vertex> origin(mesh.points.size());
  std::iota(origin.begin(), origin.end(), 0);
  const BoundaryDeviation deviation(mesh, surface, lattice.mesh.points, origin);
  EXPECT_EQ(deviation.summary().moved, 0);
  EXPECT_EQ(deviation.summary().greatest, 0);
  // Along an edge of the box: nothing deviates. Then inward.
  auto& middle = mesh.points[static_cast<std::size_t>(lattice_vertex(2, 1, 0, 0))];
  middle = {1.3, 0, 0};
  EXPECT_EQ(deviation.summary().moved, 1);
  EXPECT_NEAR(deviation.summary().greatest, 0, 1e-12);
  EXPECT_EQ(deviation.vertex_off_surface(1e-9), std::nullopt);
  middle = {1, 0.2, 0.2};
  EXPECT_NEAR(deviation.summary().greatest, 0.2 * std::sqrt(2.0), 0.05);
  EXPECT_EQ(deviation.vertex_off_surface(1e-9), lattice_vertex(2, 1, 0, 0));
}

// A vertex on the round side stands close to its neighbour: the tets there are poor while the boundary is held.
TEST(Smooth, VerticesSlideOnACurvedSurface) {
  auto lattice = make_column(6);
  auto& close = lattice.mesh.points[static_cast<std::size_t>(lattice_vertex(6, 0, 3, 3))];
  const double turn = 0.21;
  close = {close.x * std::cos(turn) - close.y * std::sin(turn), close.x * std::sin(turn) + close.y * std::cos(turn),
           close.z};
  const InputSurface surface(lattice.mesh, TetAdjacency(lattice.mesh, "mesh"));
  auto worst_after = [&](bool slide, BoundaryDeviation::Summary& summary) {
    MixedMesh mesh = to_mixed_mesh(lattice.mesh);
    std::vector<Vertex> origin(mesh.points.size());
    std::iota(origin.begin(), origin.end(), 0);
    const SlidingSurface sliding{surface, lattice.mesh.points, origin};
    smooth(mesh, 10, slide ? &sliding : nullptr);
    summary = BoundaryDeviation(mesh, surface, lattice.mesh.points, origin).summary();
    compute_quality(mesh);
    return kind_statistics(mesh)[3].least;
  };
  BoundaryDeviation::Summary held, slid;
  const double without = worst_after(false, held), with = worst_after(true, slid);
  EXPECT_GT(without, 0);
  EXPECT_GT(with, without);
  EXPECT_LT(held.greatest, 1e-9);
  EXPECT_GT(slid.greatest, 0);
  EXPECT_LT(slid.greatest, 0.03 * 0.6) << "0.6 is more than an edge";
}

TEST(Smooth, ColumnsOfHexesPassTheSelfCheck) {
  for (int n : {3, 5}) {
    const auto lattice = make_column(n);
    IndependentSet chosen;
    for (std::int32_t c = 0; c < n * n * n; ++c)
      if (c % 3 != 0) chosen.push_back(c);
    const auto result = assemble::assemble(lattice.mesh, lattice.cubes, chosen, {});
    EXPECT_GT(result.mesh.hexes.size(), 0u);
    EXPECT_LT(std::abs(result.statistics.volumes.drift), 1e-12);
  }
}

}  // namespace
}  // namespace hexpipe
