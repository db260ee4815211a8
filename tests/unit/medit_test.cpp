#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sample_meshes.hpp"

namespace hexpipe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view one_tet = R"(MeshVersionFormatted 2
Dimension 3
Vertices
4
0 0 0 1
1 0 0 1
0 1 0 1
0 0 1 1
Tetrahedra
1
1 2 3 4 7
Triangles
1
2 3 4 -5
End
)";

std::string changed(std::string_view from, std::string_view to) {
  std::string text(one_tet);
  return text.replace(text.find(from), from.size(), to);
}

TEST(Medit, ReadsCellsAndReferences) {
  const MixedMesh mesh = parsed(std::string(one_tet));
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_EQ(mesh.points[3], (Vec3{0, 0, 1}));
  EXPECT_EQ(mesh.tets.cells.at(0), (Tet{0, 1, 2, 3}));
  EXPECT_EQ(mesh.tets.tags.at(0), 7);
  EXPECT_EQ(mesh.triangles.cells.at(0), (Triangle{1, 2, 3}));
  EXPECT_EQ(mesh.triangles.tags.at(0), -5);
}

// As Mmg, TetGen and Gmsh write them: comments, other sections, other spacing and case.
TEST(Medit, SkipsWhatIsNoMesh) {
  const MixedMesh mesh = parsed(R"( MeshVersionFormatted 1

Dimension
3
# Set of mesh vertices
Vertices 4
0 0 0 1  1 0 0 1  0 1 0 1
0 0 1 1  # the last one
Corners
2
1
2

RequiredVertices
1
3
Normals
2
0 0 1
0 1e-3 -1
NormalAtVertices
1
1 2
Edges
1
1 2 3
TetrahedraP2Ordering
1
0 0 0
TETRAHEDRA
1
1 2 3 4 7
Triangles 1 2 3 4 -5
END
)");
  EXPECT_TRUE(mesh == parsed(std::string(one_tet)));
}

TEST(Medit, JoinsSectionsAndKnowsOtherSpellings) {
  const MixedMesh mesh = one_cell_of_each_kind();
  std::string text = written(mesh, "mesh");
  text.replace(text.find("Hexahedra"), 9, "Hexaedra");
  text.replace(text.find("Prisms"), 6, "Pentahedra");
  text.insert(text.find("End"), "Quadrilaterals 1  5 6 7 8 9\n");
  const MixedMesh read = parsed(text);
  EXPECT_EQ(read.hexes.size(), 1u);
  EXPECT_EQ(read.prisms.size(), 1u);
  ASSERT_EQ(read.quads.size(), 4u);
  EXPECT_EQ(read.quads.cells[3], (Quad{4, 5, 6, 7}));
  EXPECT_EQ(read.quads.tags[3], 9);
}

TEST(Medit, KeepsVerticesThatNoCellUses) {
  EXPECT_EQ(parsed(changed("4\n0 0 0 1", "5\n9 9 9 0\n0 0 0 1")).points.size(), 5u);
}

TEST(Medit, RidgesAreEdgesByTheirVertices) {
  const std::string text = changed("End", "Ridges 3 2 1 2 Edges 3 4 1 0 3 2 9 1 2 0 End");
  const MixedMesh mesh = parsed(text);
  ASSERT_TRUE(mesh.ridges);
  EXPECT_EQ(*mesh.ridges, (std::vector<Ridge>{{0, 3}, {1, 2}}));
  EXPECT_TRUE(parsed(written(mesh, "mesh")) == mesh);
  EXPECT_FALSE(parsed(changed("End", "Edges 1 4 1 0 End")).ridges);
  EXPECT_EQ(message_of_reading(changed("End", "Ridges 1 2 Edges 1 4 1 0 End")),
            "test:16: expected Ridges of edges from 1 to 1, found 2");
}

TEST(Medit, MayLackItsEnd) {
  const std::string text = changed("End\n", "");
  std::vector<std::string> warnings;
  Input input = Input::from_memory(text, "test");
  EXPECT_TRUE(read_mixed_mesh(input, nullptr, &warnings) == parsed(std::string(one_tet)));
  EXPECT_THAT(warnings, ElementsAre("test: there is no End; is the file cut off?"));
  for (std::size_t length = 0; length < text.size(); ++length) {
    const bool is_whole = text.substr(0, length).ends_with("1 2 3 4 7\n");
    EXPECT_EQ(message_of_reading(text.substr(0, length)).empty(), is_whole) << length;
  }
}

TEST(Medit, NamesTheLineOfADefect) {
  const auto expect = [](std::string_view from, std::string_view to, const std::string& message) {
    EXPECT_EQ(message_of_reading(changed(from, to)), message);
  };
  expect("Formatted 2", "Formatted 9", "test:1: expected a version from 1 to 4, found '9'");
  expect("Dimension 3", "Dimension 2", "test:2: expected dimension 3, found '2'");
  expect("1 0 0 1", "1 x 0 1", "test:6: expected a coordinate, found 'x'");
  expect("1 0 0 1", "1 nan 0 1", "test:6: expected a coordinate, found 'nan'");
  expect("Vertices\n4", "Vertices\n400",
         "test:4: expected the number of vertices that the rest of the file can hold, found 400");
  expect("Vertices\n4", "Vertices\n-4", "test:4: expected the number of vertices, found '-4'");
  expect("Vertices\n4", "Vertices\n3", "test:8: expected a keyword, or End, found '0'");
  expect("1 2 3 4 7", "1 2 3 5 7", "test:11: expected a vertex from 1 to 4, found '5'");
  expect("1 2 3 4 7", "0 2 3 4 7", "test:11: expected a vertex from 1 to 4, found '0'");
  expect("1 2 3 4 7", "1 2 3 4 7.5", "test:11: expected a reference, found '7.5'");
  expect("1 2 3 4 7", "1 2 3 4 99999999999", "test:11: expected a reference, found '99999999999'");
  expect("1 2 3 4 7", "1 2 3 4", "test:12: expected a reference, found 'Triangles'");
  expect("1 2 3 4 7", "1 2 3 3 7", "test: tets[0]: expected 4 different vertices, found 2 twice");
  expect("Tetrahedra", "TetrahedraP2", "test:9: expected elements of first order only, found 'TetrahedraP2'");
  expect("End\n", "Triangles 0", "test:15: expected a keyword, or End, found end of file");
  expect("End", "End more", "test:15: expected nothing after End, found 'more'");
  expect("Vertices", "Corners", "test:9: expected Vertices before Tetrahedra");
  expect("Triangles", "Vertices", "test:12: expected one section Vertices, found a second");
  EXPECT_EQ(message_of_reading("MeshVersionFormatted 2 Dimension 3 End"), "test:1: expected Vertices, found none");
}

}  // namespace
}  // namespace hexpipe
