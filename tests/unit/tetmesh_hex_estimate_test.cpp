#include "tools/tetmesh/volume/estimates.hpp"

#include <gtest/gtest.h>

#include "tetmesh_surfaces.hpp"

namespace hexpipe {
using namespace tetmesh::solid;
using namespace tetmesh::tetgen;
using namespace tetmesh::volume;
namespace {

double share_of_box(int n, double moved) {
  const Surface surface = testing::surface_of(testing::cube(0, n, n));
  const BuiltMesh built = testing::mesh_of(surface, testing::lattice_in_cube(n, moved));
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
