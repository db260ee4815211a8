// The lines that viewmesh draws where rows of points end.

#include <gtest/gtest.h>

#include "tests/unit/viewmesh_lattice.hpp"
#include "tools/viewmesh/dislocation_lines.hpp"

namespace hexpipe {
using namespace viewmesh;
namespace {

TEST(DislocationLines, GoOnFromSegmentToSegmentWhicheverWayTheyAreListed) {
  const auto lines = join_segments({{1, 0, 0, 2, 0, 0}, {1, 0, 0, 0, 0, 0}, {3, 1, 0, 2, 0, 0}});
  ASSERT_EQ(lines.size(), 1);
  ASSERT_EQ(lines[0].size(), 4);
  EXPECT_DOUBLE_EQ(length_of(lines[0]), 2 + std::sqrt(2.0));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(norm(lines[0][i + 1] - lines[0][i]), 1.5);
}

TEST(DislocationLines, EndWhereThreeMeet) {
  const auto lines = join_segments({{0, 0, 0, 1, 0, 0}, {0, 0, 0, 0, 2, 0}, {0, 0, 0, 0, 0, 3}, {0, 0, 3, 0, 0, 5}});
  ASSERT_EQ(lines.size(), 3);
  EXPECT_DOUBLE_EQ(length_of(lines[0]), 5);
  EXPECT_EQ(lines[0].size(), 3);
  EXPECT_DOUBLE_EQ(length_of(lines[2]), 1);
}

TEST(DislocationLines, OfALoopEndWhereItBegins) {
  const auto lines = join_segments({{0, 0, 0, 1, 0, 0}, {1, 0, 0, 1, 1, 0}, {1, 1, 0, 0, 0, 0}});
  ASSERT_EQ(lines.size(), 1);
  EXPECT_EQ(lines[0].size(), 4);
  EXPECT_EQ(lines[0].front(), lines[0].back());
}

TEST(DislocationLines, OfNothingAreNone) {
  EXPECT_TRUE(join_segments({}).empty());
}

TEST(DislocationLines, ArePlacedAsThePointsAre) {
  pipeline::StageData data = hex_lattice(2);
  data.dislocations = {{1, 1, 0, 1, 1, 2}};
  const Scene scene = make_scene(data, Scene::Content::result, "test");
  ASSERT_EQ(scene.dislocations.size(), 1);
  for (const Vec3& p : scene.dislocations[0]) {
    EXPECT_NEAR(p.x, 0, 1e-12);
    EXPECT_NEAR(std::abs(p.z), 1 / std::sqrt(3.0), 1e-12);
  }
}

}  // namespace
}  // namespace hexpipe
