#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/cell_topology.hpp"
#include "common/run/error.hpp"
#include "common/run/parallel.hpp"
#include "surface_samples.hpp"
#include "tools/tetmesh/meshing.hpp"
#include "tools/tetmesh/tetmesh.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh;
using namespace tetmesh::sizing;
using namespace tetmesh::solid;
namespace {

using testing::box;
using testing::cube;
using testing::Facets;
using testing::inverted;
using testing::joined;
using testing::soup_of;
using testing::sphere;

TetmeshResult run(const Facets& facets, const TetmeshOptions& options) {
  return tetmesh::tetmesh(soup_of(facets), options);
}

// Every facet between two regions or a region and nothing is a triangle of the mesh, outward from the lower region, and
// the other way round.
void expect_triangles_bound_the_tets(const TetMesh& mesh) {
  const TetAdjacency adjacency(mesh, "mesh");
  std::vector<Triangle> bounding;
  for (const auto t : indices<TetIndex>(mesh.tets.size())) {
    EXPECT_GT(tet_determinant(mesh.points, mesh.tets[t]), 0);
    for (std::size_t facet = 0; facet < 4; ++facet) {
      const TetIndex beyond = adjacency.tet_beyond(t, static_cast<int>(facet));
      if (beyond != no_index && mesh.tet_tags[beyond] == mesh.tet_tags[t]) continue;
      Triangle triangle;
      for (std::size_t i = 0; i < 3; ++i) triangle[i] = mesh.tets[t][TetTopology::triangles[facet][i]];
      std::ranges::rotate(triangle, std::ranges::min_element(triangle));
      bounding.push_back(triangle);
    }
  }
  std::ranges::sort(bounding);
  for (Triangle triangle : mesh.triangles) {
    std::ranges::rotate(triangle, std::ranges::min_element(triangle));
    EXPECT_TRUE(std::ranges::binary_search(bounding, triangle));
  }
  EXPECT_GE(bounding.size(), mesh.triangles.size());
  EXPECT_LE(bounding.size(), 2 * mesh.triangles.size());
}

TEST(Tetmesh, FillsWhatTheShellsEnclose) {
  const Facets hollow = joined(sphere({0, 0, 0}, 3, 12), inverted(sphere({0.4, 0.3, 0.2}, 1.6, 9)));
  const Facets nested = joined(cube(0, 3, 6), sphere({1.5, 1.5, 1.5}, 1, 8));
  const Facets apart = joined(cube(0, 1, 3), cube(2, 1, 4));
  for (const Facets& facets : {hollow, nested, apart}) {
    const Surface surface = find_shells(soup_of(facets), ShellRule::oriented);
    for (const PointKind points : {PointKind::lattice, PointKind::none}) {
      const TetmeshResult result =
          run(facets, {.sizes = {.size = Length{0.3, false}}, .surface = SurfaceKind::keep, .points = points});
      const auto volumes = surface.region_volumes();
      EXPECT_NEAR(result.statistics.volume, std::accumulate(volumes.begin(), volumes.end(), 0.0), 1e-9);
      EXPECT_EQ(result.statistics.dropped_points, 0u);
      EXPECT_EQ(result.statistics.interior_points > 0, points == PointKind::lattice);
      EXPECT_EQ(std::ranges::max(result.mesh.tet_tags), surface.region_count);
      expect_triangles_bound_the_tets(result.mesh);
    }
  }
}

TEST(Tetmesh, TagsComeFromTheFileOrFromTheShells) {
  SurfaceSoup soup = soup_of(joined(cube(0, 1), cube(2, 1)));
  const TetmeshOptions options{.sizes = {.size = Length{0.5, false}}, .surface = SurfaceKind::keep};
  const auto by_shell = tetmesh::tetmesh(soup, options).mesh.triangle_tags;
  EXPECT_EQ(by_shell.front(), 1);
  EXPECT_EQ(by_shell.back(), 2);
  for (std::size_t i = 0; i < soup.tags.size(); ++i) soup.tags[i] = static_cast<std::int32_t>(i % 5);
  EXPECT_EQ(tetmesh::tetmesh(soup, options).mesh.triangle_tags, soup.tags);
}

TEST(Tetmesh, RefusesAJitterThatReachesTheSurface) {
  EXPECT_THROW(run(cube(), {.clearance = 0.5, .jitter = 0.25}), UsageError);
  EXPECT_NO_THROW(run(cube(), {.sizes = {.size = Length{0.2, false}}, .clearance = 0.5, .jitter = 0.24}));
  EXPECT_NO_THROW(run(cube(), {.points = PointKind::none, .clearance = 0.5, .jitter = 0.25}));
}

TEST(Tetmesh, WarnsOfASurfaceFarFromTheSize) {
  EXPECT_EQ(run(cube(), {.sizes = {.size = Length{0.2, false}}, .surface = SurfaceKind::keep}).warnings.size(), 1u);
  EXPECT_TRUE(run(cube(), {.sizes = {.size = Length{0.2, false}}}).warnings.empty());
  EXPECT_TRUE(
      run(cube(0, 1, 5), {.sizes = {.size = Length{0.2, false}}, .surface = SurfaceKind::keep}).warnings.empty());
  EXPECT_TRUE(
      run(cube(), {.sizes = {.size = Length{0.2, false}}, .surface = SurfaceKind::keep, .points = PointKind::none})
          .warnings.empty());
}

TEST(Tetmesh, MeasuresDihedralAngles) {
  // One tet with three right angles; the others are arccos(1 / sqrt(3)).
  const Vec3 o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const TetmeshResult result =
      run({{o, y, x}, {o, x, z}, {o, z, y}, {x, y, z}}, {.surface = SurfaceKind::keep, .points = PointKind::none});
  EXPECT_EQ(result.statistics.tets, 1u);
  EXPECT_NEAR(result.statistics.greatest_dihedral, 90, 1e-9);
  EXPECT_NEAR(result.statistics.least_dihedral, 54.735610317, 1e-8);
}

// A leaf: new triangles of its two sides cross each other.
Facets leaf() {
  Facets facets = sphere({0, 0, 0}, 1, 10);
  for (auto& facet : facets)
    for (Vec3& p : facet) p = {p.x, 0.15 * p.y, 0.02 * p.z + 0.3 * p.x * p.x};
  return facets;
}

TEST(Tetmesh, FillsNoSurfaceThatTurnsOutToBeFaulty) {
  const TetmeshOptions mended{.sizes = {.size = Length{0.8, false}}, .deviation = 0.5};
  const TetmeshOptions given_up{.sizes = {.size = Length{0.8, false}}, .deviation = 0.15};
  for (const TetmeshOptions& options : {mended, given_up}) {
    const auto with_threads = [&](int threads) {
      const ThreadLimit limit(threads);
      return run(leaf(), options);
    };
    // On two threads it is meshed before it is known to be faulty.
    const TetmeshResult one = with_threads(1), two = with_threads(2);
    EXPECT_GT(two.statistics.surfaces_tried, 1);
    EXPECT_EQ(two.statistics.remeshed, options.deviation == mended.deviation);
    EXPECT_EQ(two.warnings.empty(), two.statistics.remeshed);
    EXPECT_EQ(two.mesh.points, one.mesh.points);
    EXPECT_EQ(two.mesh.tets, one.mesh.tets);
    expect_triangles_bound_the_tets(two.mesh);
  }
}

TEST(Fill, EstimatesUnlessMuchOfALargeMeshIsTurned) {
  EXPECT_TRUE(frame_plainly_wins(true, 0.21, 8001));
  EXPECT_FALSE(frame_plainly_wins(true, 0.21, 8000));
  EXPECT_FALSE(frame_plainly_wins(true, 0.19, 100000));
  EXPECT_FALSE(frame_plainly_wins(false, 1, 100000));
}

TEST(Fill, TakesTheFrameUnlessTheLatticeIsClearlyBetter) {
  EXPECT_TRUE(frame_wins(0.9, 0.95));
  EXPECT_TRUE(frame_wins(0.9889, 0.9876));  // notch: 97.6 % of the number with the lattice, 98.8 with the frame
  EXPECT_FALSE(frame_wins(0.95, 0.939));
}

}  // namespace
}  // namespace hexpipe
