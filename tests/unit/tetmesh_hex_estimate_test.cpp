#include "tools/tetmesh/volume/hex_estimate.hpp"

#include <gtest/gtest.h>

#include "common/run/random.hpp"
#include "surface_samples.hpp"
#include "tools/tetmesh/build_mesh.hpp"

namespace hexpipe {
namespace {

// A box of n x n x n squares, with points inside that are those of the lattice, moved at random by up to `moved` of the
// cells.
double share_of_box(int n, double moved) {
  const Surface surface =
      find_shells(testing::soup_of(testing::cube(0, static_cast<double>(n), n)), ShellRule::oriented);
  Random random(1);
  std::vector<Vec3> inside;
  for (int k = 1; k < n; ++k)
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < n; ++i)
        inside.push_back(
            {i + moved * random.uniform(-1, 1), j + moved * random.uniform(-1, 1), k + moved * random.uniform(-1, 1)});
  TetGenResult tetgen =
      run_tetgen({.surface_points = surface.points, .triangles = surface.triangles, .interior_points = inside}, 60);
  const BuiltMesh built = build_mesh(surface, inside, std::move(tetgen));
  return estimate_hex_share(built.mesh, built.adjacency);
}

TEST(HexEstimate, IsAllOfALattice) {
  EXPECT_GT(share_of_box(6, 0.01), 0.97);
  EXPECT_LE(share_of_box(6, 0.01), 1 + 1e-9);
}

TEST(HexEstimate, FallsAsPointsLeaveTheLattice) {
  const double lattice = share_of_box(7, 0.02), moved = share_of_box(7, 0.15), random = share_of_box(7, 0.4);
  EXPECT_GT(lattice, moved + 0.02);
  EXPECT_GT(moved, random + 0.2);
  EXPECT_LT(random, 0.5);
}

TEST(HexEstimate, OfASingleTetIsNothing) {
  const TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {1}, {}, {}};
  EXPECT_EQ(estimate_hex_share(mesh, TetAdjacency(mesh, "tet")), 0);
}

}  // namespace
}  // namespace hexpipe
