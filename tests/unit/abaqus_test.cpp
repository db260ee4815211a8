#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sample_meshes.hpp"

namespace hexpipe {
using namespace formats;
namespace {

using ::testing::HasSubstr;

// Small enough to be read; the faces are those of the Abaqus manual for each element.
TEST(Abaqus, WritesElementsSetsAndSurfaces) {
  EXPECT_EQ(written(one_cell_of_each_kind(), "inp"), R"(*HEADING
hexpipe mesh
*NODE, NSET=NALL
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
9, 2, 0.5, 0.5
10, 0, 0.5, 2
11, 1, 0.5, 2.1
*ELEMENT, TYPE=C3D8, ELSET=EALL
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D6, ELSET=EALL
2, 5, 8, 10, 6, 7, 11
*ELEMENT, TYPE=C3D5, ELSET=EALL
3, 2, 3, 7, 6, 9
*ELEMENT, TYPE=C3D4, ELSET=EALL
4, 7, 6, 9, 11
*ELSET, ELSET=region_1
1
*NSET, NSET=region_1
1, 2, 3, 4, 5, 6, 7, 8
*ELSET, ELSET=region_2
2
*NSET, NSET=region_2
5, 6, 7, 8, 10, 11
*ELSET, ELSET=region_3
3
*NSET, NSET=region_3
2, 3, 6, 7, 9
*ELSET, ELSET=region_4
4
*NSET, NSET=region_4
6, 7, 9, 11
*NSET, NSET=surface_7
2, 3, 6, 7
*SURFACE, NAME=surface_7, TYPE=ELEMENT
1, S4
*NSET, NSET=surface_10
1, 2, 3, 4, 6, 9, 11
*SURFACE, NAME=surface_10, TYPE=ELEMENT
4, S3
1, S1
*NSET, NSET=surface_20
1, 2, 3, 5, 6, 9
*SURFACE, NAME=surface_20, TYPE=ELEMENT
3, S2
1, S3
*NSET, NSET=surface_30
5, 8, 10
*SURFACE, NAME=surface_30, TYPE=ELEMENT
2, S1
)");
}

// The corners of each face as the Abaqus manual numbers them, from 1.
struct Faces {
  CellKind kind;
  std::vector<std::vector<int>> corners;
};
const std::vector<Faces>& manual() {
  static const std::vector<Faces> faces{
      {CellKind::hex, {{1, 2, 3, 4}, {5, 8, 7, 6}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 8, 4}, {4, 8, 5, 1}}},
      {CellKind::prism, {{1, 2, 3}, {4, 6, 5}, {1, 4, 5, 2}, {2, 5, 6, 3}, {3, 6, 4, 1}}},
      {CellKind::pyramid, {{1, 2, 3, 4}, {1, 5, 2}, {2, 5, 3}, {3, 5, 4}, {4, 5, 1}}},
      {CellKind::tet, {{1, 2, 3}, {1, 4, 2}, {2, 4, 3}, {3, 4, 1}}}};
  return faces;
}

template <class Block, std::size_t Corners>
void set_only_cell(Block& block, std::array<Vertex, Corners>) {
  typename std::remove_cvref_t<decltype(block.cells)>::value_type cell{};
  for (std::size_t i = 0; i < cell.size(); ++i) cell[i] = static_cast<Vertex>(i);
  block.cells = {cell};
  block.tags = {1};
}

TEST(Abaqus, NumbersTheFacesOfEveryKind) {
  for (const Faces& faces : manual())
    for (std::size_t face = 0; face < faces.corners.size(); ++face) {
      MixedMesh mesh;
      mesh.points.resize(8);
      for_each_block(mesh, [&](const ElementNames& names, auto& block) {
        if (names.dimension == 3 && names.vtk == static_cast<std::uint8_t>(faces.kind))
          set_only_cell(block, std::array<Vertex, 1>{});
      });
      const std::vector<int>& corners = faces.corners[face];
      if (corners.size() == 3)
        mesh.triangles = {{{corners[0] - 1, corners[1] - 1, corners[2] - 1}}, {9}, {}};
      else
        mesh.quads = {{{corners[0] - 1, corners[1] - 1, corners[2] - 1, corners[3] - 1}}, {9}, {}};
      EXPECT_THAT(written(mesh, "inp"), HasSubstr(fmt::format("NAME=surface_9, TYPE=ELEMENT\n1, S{}\n", face + 1)))
          << name_of(faces.kind);
    }
}

TEST(Abaqus, NegativeTagsMakeNames) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.hexes.tags = {-3};
  mesh.quads.tags = {0, -1, std::numeric_limits<std::int32_t>::min()};
  const std::string text = written(mesh, "inp");
  for (const char* name : {"ELSET=region_m3\n", "NAME=surface_0,", "NAME=surface_m1,", "NAME=surface_m2147483648,"})
    EXPECT_THAT(text, HasSubstr(name));
}

TEST(Abaqus, SetsHaveSixteenElementsALine) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.tets.cells.assign(33, mesh.tets.cells[0]);
  mesh.tets.tags.assign(33, 4);
  EXPECT_THAT(written(mesh, "inp"),
              HasSubstr("*ELSET, ELSET=region_4\n4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19\n20, 21, 22, "
                        "23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35\n36\n*NSET"));
}

// The faces of the hex that a collapsed pyramid is: one of its triangles has the edge of the base that the hex's side
// has.
TEST(Abaqus, NumbersTheFacesOfCollapsedPyramids) {
  MeshWriting writing;
  writing.pyramids = PyramidForm::collapsed;
  for (std::size_t face = 0; face < 5; ++face) {
    MixedMesh mesh;
    mesh.points.resize(5);
    mesh.pyramids = {{{0, 1, 2, 3, 4}}, {1}, {}};
    const std::vector<int>& corners = manual()[2].corners[face];
    if (corners.size() == 3)
      mesh.triangles = {{{corners[0] - 1, corners[1] - 1, corners[2] - 1}}, {9}, {}};
    else
      mesh.quads = {{{corners[0] - 1, corners[1] - 1, corners[2] - 1, corners[3] - 1}}, {9}, {}};
    const std::string text =
        testing::written_bytes([&](Output& output) { write_mixed_mesh(mesh, "inp", output, writing); });
    EXPECT_THAT(text, HasSubstr("TYPE=C3D8, ELSET=EALL\n1, 1, 2, 3, 4, 5, 5, 5, 5\n"));
    EXPECT_THAT(text, HasSubstr(fmt::format("ELEMENT\n1, S{}\n", face == 0 ? 1 : face + 2)));
  }
}

TEST(Abaqus, RefusesFacetsOfNoCell) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.triangles.cells[1] = {0, 1, 2};
  EXPECT_THAT([&] { written(mesh, "inp"); },
              ::testing::ThrowsMessage<DataError>(HasSubstr("cannot write triangles[1]: Abaqus surfaces consist of")));
}

}  // namespace
}  // namespace hexpipe
