#include "formats/meshes/mesh_writing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/mesh/quality.hpp"
#include "sample_meshes.hpp"

namespace hexpipe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

double volume_of_tets(const MixedMesh& mesh) {
  double volume = 0;
  for (const auto& tet : mesh.tets.cells) {
    const auto at = corner_points(mesh.points, tet);
    const double part = cell_volume(CellKind::tet, std::span<const Vec3>(at).first(4));
    EXPECT_GT(part, 0);
    volume += part;
  }
  return volume;
}

TEST(MeshWriting, SplitsPyramidsAtTheLowestVertexOfTheirBase) {
  MixedMesh mesh;
  mesh.points = {{1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}};
  mesh.pyramids = {{{2, 3, 0, 1, 4}, {3, 2, 1, 0, 5}}, {7, 8}, {}};
  mesh.quads = {{{2, 3, 0, 1}}, {5}, {}};
  const MixedMesh split = with_split_pyramids(mesh);
  EXPECT_THAT(split.tets.tags, ElementsAre(7, 7, 8, 8));
  EXPECT_NEAR(volume_of_tets(split), 2.0 / 3, 1e-14);
  EXPECT_EQ(split.pyramids.size(), 0u);
  // The base is a facet of pyramids alone: both halves hold vertex 0 and 2.
  EXPECT_EQ(split.quads.size(), 0u);
  EXPECT_THAT(split.triangles.cells, ElementsAre(std::array{0, 1, 2}, std::array{0, 2, 3}));
  EXPECT_THAT(split.triangles.tags, ElementsAre(5, 5));
}

TEST(MeshWriting, KeepsQuadsThatOtherCellsHave) {
  const MixedMesh mesh = one_cell_of_each_kind();
  const MixedMesh split = with_split_pyramids(mesh);
  EXPECT_EQ(split.quads.cells, mesh.quads.cells);
  EXPECT_EQ(split.tets.size(), mesh.tets.size() + 2);
}

TEST(MeshWriting, RefusesMoreThanAFormatCanNumber) {
  EXPECT_NO_THROW(check_numbers(99, 99, "a"));
  EXPECT_THAT([] { check_numbers(100, 99, "a.bdf"); },
              ThrowsMessage<DataError>(HasSubstr("a.bdf: cannot write 100 points or elements: the format numbers at")));
}

TEST(MeshWriting, TakesRoundingForNothing) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.points[0].x = 1e-16;
  mesh.points[1].y = -1e-13;
  const std::string text = written(mesh, "inp");
  EXPECT_THAT(text, HasSubstr("\n1, 0, 0, 0\n2, 1, -1e-13, 0\n"));
}

// The pair of surface and region numbers of Nastran's properties is read back as tags.
TEST(MeshWriting, NastranAndSu2ReadWhatTheyWrite) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    MixedMesh mesh = random_mesh(seed);
    drop_quality(mesh);
    // Coordinates of one size: Nastran's have 16 characters, and what is small beside the others is nothing.
    for (std::size_t i = 0; i < mesh.points.size(); ++i) mesh.points[i] = {0.5 * static_cast<double>(i), 1, -0.25};
    EXPECT_EQ(written(parsed(written(mesh, "bdf")), "bdf"), written(mesh, "bdf"));
    if (mesh.cell_count() == 0) continue;
    mesh.triangles = {}, mesh.quads = {};
    for_each_block(mesh, [](const ElementNames&, auto& block) { std::ranges::fill(block.tags, 1); });
    EXPECT_TRUE(parsed(written(mesh, "su2")) == mesh);
  }
}

}  // namespace
}  // namespace hexpipe
