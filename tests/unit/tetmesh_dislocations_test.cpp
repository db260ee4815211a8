#include "tools/tetmesh/volume/dislocations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/tetmesh_blocks.hpp"

namespace hexpipe {
using namespace tetmesh;
using namespace tetmesh::volume;
namespace {

constexpr std::int32_t width = 6, height = 4;  // cubes of a block, each of six tets

std::int32_t number_of(std::int32_t x, std::int32_t y, std::int32_t z) {
  return (z * (width + 1) + y) * (width + 1) + x;
}

TetMesh block() {
  TetMesh mesh;
  for (const auto& [x, y, z] : testing::places_up_to({width, width, height}))
    mesh.points.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  testing::fill_with_cubes(
      {width, width, height}, [](const testing::Place& at) { return number_of(at[0], at[1], at[2]); }, mesh);
  return mesh;
}

// A lattice on the block; its frames are the axes.
struct Lattice {
  TetMesh mesh = block();
  TetAdjacency adjacency{mesh, "block"};
  FieldNodes nodes = testing::nodes_on(mesh, adjacency);
  std::vector<fields::Frame> frames{nodes.size(), fields::Frame{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::vector<std::array<double, 3>> coordinates = std::vector<std::array<double, 3>>(nodes.size());

  Dislocations dislocations() const {
    const LatticeLinks links(nodes, frames);
    return find_dislocations(links, coordinates, mesh, adjacency);
  }
  // A row of points more on the one side of the line along z than on the other.
  void end_a_row_at(double x, double y) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3& p = nodes.points[i];
      const double moved = coordinates[i][0] + std::atan2(p.y - y, p.x - x) / (2 * std::numbers::pi);
      coordinates[i][0] = moved - std::round(moved);
    }
  }
};

TEST(Dislocations, AreNoneWhereNoRowEnds) {
  const Dislocations found = Lattice().dislocations();
  EXPECT_EQ(found.length, 0);
  EXPECT_TRUE(found.segments.empty());
  EXPECT_EQ(found.surface_ends, 0u);
}

TEST(Dislocations, LeadFromSurfaceToSurface) {
  Lattice lattice;
  lattice.end_a_row_at(2.4, 3.3);
  const Dislocations found = lattice.dislocations();
  EXPECT_NEAR(found.length, height, 0.5);
  EXPECT_EQ(found.surface_ends, 2u);
  EXPECT_EQ(found.at_singularities, 0);
  EXPECT_EQ(found.closed, 0);
  for (const auto& [x, y, z, to_x, to_y, to_z] : found.segments) {
    EXPECT_NEAR(x, 2.4, 1);
    EXPECT_NEAR(to_y, 3.3, 1);
    EXPECT_TRUE(y > 2 && z >= 0 && to_x > 1 && to_z <= height);
  }
}

TEST(Dislocations, CountAsOftenAsRowsEnd) {
  Lattice lattice;
  for (int i = 0; i < 2; ++i) lattice.end_a_row_at(2.4, 3.3);
  const Dislocations found = lattice.dislocations();
  EXPECT_NEAR(found.length, 2 * height, 1.5);
  EXPECT_EQ(found.surface_ends, 4u);
}

// Frames of one column are turned by 30 degrees, those beside it by as much the other way: rows cannot be followed from
// the ones to the others.
TEST(Dislocations, EndAtSingularities) {
  Lattice lattice;
  lattice.end_a_row_at(2.4, 3.3);
  const double cosine = std::cos(0.5), sine = std::sin(0.5);
  for (std::int32_t y = 3; y <= 4; ++y) {
    const double turn = y == 3 ? sine : -sine;
    for (std::int32_t x = 2; x <= 3; ++x)
      lattice.frames[static_cast<std::size_t>(number_of(x, y, 2))] = {
          Vec3{cosine, turn, 0}, {-turn, cosine, 0}, {0, 0, 1}};
  }
  const Dislocations found = lattice.dislocations();
  EXPECT_GT(found.at_singularities, 0);
  EXPECT_LE(found.at_singularities, found.length);
}

}  // namespace
}  // namespace hexpipe
