#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "assemble_lattice.hpp"
#include "common/mesh/adjacency.hpp"
#include "common/mesh/quality.hpp"
#include "tools/assemble/conform/flat_tets.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"

namespace hexpipe {
using namespace assemble::conform;
using namespace assemble::hybrid;
namespace {

using testing::tag_boundary;

double quality(const HybridMesh& mesh, TetIndex t) {
  const auto at = corner_points(mesh.points, mesh.tet(t));
  return std::sqrt(2.0) * least_corner_scaled_jacobian(CellKind::tet, std::span<const Vec3>(at).first(4));
}

struct Sums {
  int tets = 0;
  double worst = 1, volume = 0;

  explicit Sums(const HybridMesh& mesh) {
    for (const auto t : indices<TetIndex>(mesh.tet_count())) {
      if (!mesh.is_alive(t)) continue;
      ++tets;
      worst = std::min(worst, quality(mesh, t));
      volume += tet_determinant(mesh.points, mesh.tet(t)) / 6;
    }
  }
};

// A regular ring of `n` tets around a short edge.
TetMesh ring(int n, double half_length) {
  TetMesh mesh;
  mesh.points = {{0, 0, -half_length}, {0, 0, half_length}};
  for (int i = 0; i < n; ++i) mesh.points.push_back({std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n), 0});
  for (int i = 0; i < n; ++i) mesh.tets.push_back({0, 1, 2 + i, 2 + (i + 1) % n});
  mesh.tet_tags.assign(static_cast<std::size_t>(n), 1);
  mesh.triangle_tags.clear();
  return mesh;
}

HybridMesh hybrid_of(const TetMesh& mesh) {
  return HybridMesh(mesh, std::vector<bool>(mesh.tets.size()));
}

// The tets are looked for at the vertex that has fewest, which must not be seen in the results of what asks.
TEST(HybridMesh, GivesTheTetsAtAnEdgeInTheSameOrderFromBothEnds) {
  HybridMesh hybrid = hybrid_of(ring(6, 0.3));
  hybrid.remove_tet(TetIndex(1));
  hybrid.remove_tet(TetIndex(4));
  hybrid.add_tet({0, 1, 3, 4}, 1);
  hybrid.restore_tet(TetIndex(4));
  const auto has = [&](TetIndex t, Vertex v) {
    const Tet& tet = hybrid.tet(t);
    return std::ranges::find(tet, v) != tet.end();
  };
  for (Vertex a = 0; a < 8; ++a)
    for (Vertex b = 0; b < 8; ++b) {
      if (a == b) continue;
      std::vector<TetIndex> found, expected;
      hybrid.tets_around_edge(a, b, found);
      hybrid.for_tets_at(a, [&](TetIndex t) {
        if (has(t, b)) expected.push_back(t);
      });
      EXPECT_EQ(found, expected) << a << ' ' << b;
    }
  EXPECT_EQ(hybrid.tet_at({0, 1, 4}, TetIndex(2)), TetIndex(6));
  EXPECT_EQ(hybrid.tet_at({4, 1, 0}, TetIndex(6)), TetIndex(2));
}

TEST(Flip, AFacetGivesWayToAnEdge) {
  // Two flat tets on one large facet: the three around the edge between their tips are better.
  TetMesh mesh = ring(3, 0.3);
  mesh.tets = {{2, 3, 4, 1}, {2, 4, 3, 0}};
  mesh.tet_tags = {1, 1};
  mesh.points[0].z = -0.9, mesh.points[1].z = 0.02;
  tag_boundary(mesh);
  const SurfaceTags tags(mesh);
  auto hybrid = hybrid_of(mesh);
  const Sums before(hybrid);
  EXPECT_EQ(flip_poor_tets(hybrid, tags, 0.2), 1);
  const Sums after(hybrid);
  EXPECT_EQ(after.tets, 3);
  EXPECT_GT(after.worst, before.worst);
  EXPECT_NEAR(after.volume, before.volume, 1e-12);
}

TEST(Flip, ALongEdgeGivesWayToATriangulationOfItsRing) {
  for (int n = 3; n <= 5; ++n) {
    SCOPED_TRACE(n);
    TetMesh mesh = ring(n, 3);
    mesh.points[2].x = 1.2;  // one triangulation is better than its rotations
    tag_boundary(mesh);
    const SurfaceTags tags(mesh);
    auto hybrid = hybrid_of(mesh);
    const Sums before(hybrid);
    EXPECT_EQ(flip_poor_tets(hybrid, tags, 0.9), 1);
    const Sums after(hybrid);
    EXPECT_EQ(after.tets, 2 * (n - 2));
    EXPECT_GT(after.worst, before.worst);
    EXPECT_NEAR(after.volume, before.volume, 1e-12);
  }
}

TEST(Flip, TaggedFacetsRegionsAndDiagonalsOfQuadsStay) {
  TetMesh mesh = ring(3, 0.3);
  mesh.tets = {{2, 3, 4, 1}, {2, 4, 3, 0}};
  mesh.tet_tags = {1, 1};
  mesh.points[0].z = -0.9, mesh.points[1].z = 0.02;
  tag_boundary(mesh);

  TetMesh two_regions = mesh;
  two_regions.tet_tags = {1, 2};
  auto hybrid = hybrid_of(two_regions);
  EXPECT_EQ(flip_poor_tets(hybrid, SurfaceTags(two_regions), 0.2), 0);

  TetMesh with_interface = mesh;
  with_interface.triangles.push_back({2, 3, 4});
  with_interface.triangle_tags.push_back(5);
  hybrid = hybrid_of(with_interface);
  EXPECT_EQ(flip_poor_tets(hybrid, SurfaceTags(with_interface), 0.2), 0);

  hybrid = hybrid_of(mesh);
  HybridCell pyramid;
  pyramid.kind = CellKind::pyramid;
  pyramid.corners = {0, 2, 1, 3, 4, -1, -1, -1};  // 0 and 1 are opposite in its base
  hybrid.add_cell(pyramid);
  EXPECT_EQ(flip_poor_tets(hybrid, SurfaceTags(mesh), 0.2), 0);
}

TEST(Flip, WorksThroughAWholeMesh) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = testing::make_lattice(6);
    testing::jitter(lattice, 0.3, random);
    tag_boundary(lattice.mesh);
    const SurfaceTags tags(lattice.mesh);
    auto hybrid = hybrid_of(lattice.mesh);
    const Sums before(hybrid);
    EXPECT_GT(flip_poor_tets(hybrid, tags, 0.3), 10);
    const Sums after(hybrid);
    EXPECT_GT(after.worst, before.worst);
    EXPECT_NEAR(after.volume, before.volume, 1e-9);
    EXPECT_EQ(flip_poor_tets(hybrid, tags, 0.3), 0) << "another pass finds nothing more";
  }
}

}  // namespace
}  // namespace hexpipe
