#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "sample_meshes.hpp"

namespace hexpipe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view two_tets_2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
10 0 0 0
7 1 0 0
3000000 0 1 0
8 0 0 1
9 1 1 1
$EndNodes
$Elements
4
1 15 2 0 1 10
2 1 2 0 1 10 7
3 4 2 5 1 10 7 3000000 8
4 2 3 6 2 0 10 7 8
$EndElements
)";

constexpr std::string_view two_regions_4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
1 1 1 2
1 0 0 0 1 40
1 0 0 0 1 0 0 0 1 1
9 0 0 0 1 1 1 2 -30 31 1 1
1 0 0 0 1 1 1 1 5 1 9
2 0 0 0 1 1 1 1 6 1 -9
$EndEntities
$Nodes
2 5 1 100
0 1 0 1
100
0 0 0
3 1 1 4
2
3
5
4
1 0 0 .5 .5 .5
0 1 0 .5 .5 .5
0 0 1 .5 .5 .5
1 1 1 .5 .5 .5
$EndNodes
$Elements
4 4 1 40
0 1 15 1
1 100
3 2 4 1
40 2 3 5 4
3 1 4 1
12 100 2 3 5
2 9 2 1
13 2 3 5
$EndElements
)";

std::string changed(std::string_view text, std::string_view from, std::string_view to) {
  std::string copy(text);
  return copy.replace(copy.find(from), from.size(), to);
}

TEST(Msh, ReadsVersion2WithSparseNodeNumbers) {
  const MixedMesh mesh = parsed(std::string(two_tets_2));
  EXPECT_EQ(mesh.points.size(), 5u);
  EXPECT_THAT(mesh.tets.cells, ElementsAre(Tet{0, 1, 2, 3}));
  EXPECT_THAT(mesh.tets.tags, ElementsAre(5));
  EXPECT_THAT(mesh.triangles.cells, ElementsAre(Triangle{0, 1, 3}));
  EXPECT_THAT(mesh.triangles.tags, ElementsAre(6));
}

TEST(Msh, ReadsVersion4WithEntitiesAndParametricNodes) {
  const MixedMesh mesh = parsed(std::string(two_regions_4));
  EXPECT_EQ(mesh.points.size(), 5u);
  EXPECT_EQ(mesh.points[1], (Vec3{1, 0, 0}));
  // By the numbers of the elements.
  EXPECT_THAT(mesh.tets.cells, ElementsAre(Tet{0, 1, 2, 3}, Tet{1, 2, 3, 4}));
  EXPECT_THAT(mesh.tets.tags, ElementsAre(5, 6));
  // The first of two groups; a negative number means that the surface is turned round.
  EXPECT_THAT(mesh.triangles.tags, ElementsAre(30));
  EXPECT_THAT(mesh.triangles.cells, ElementsAre(Triangle{1, 3, 2}));
}

TEST(Msh, EntitiesAreTagsWhereADimensionHasNoGroups) {
  const std::string text = changed(changed(two_regions_4, "1 1 5 1 9", "1 0 1 9"), "1 1 6 1 -9", "1 0 1 -9");
  const MixedMesh mesh = parsed(text);
  EXPECT_THAT(mesh.tets.tags, ElementsAre(1, 2));
  EXPECT_THAT(mesh.triangles.tags, ElementsAre(30));
  EXPECT_THAT(parsed(changed(two_tets_2, "4 2 5 1", "4 2 0 1")).tets.tags, ElementsAre(1));
  // With one group in a dimension, the others there are in none.
  EXPECT_THAT(parsed(changed(two_regions_4, "1 1 6 1 -9", "1 0 1 -9")).tets.tags, ElementsAre(5, 0));
}

// Both volumes in two parts each, and a surface between the parts of the first.
TEST(Msh, PartsOfEntitiesAreThoseEntities) {
  constexpr std::string_view parts = R"($PartitionedEntities
2
1
11 2
0 0 2 3
50 2 9 1 1 0 0 0 1 1 1 1 30 0
51 3 1 2 1 2 0 0 0 1 1 1 0 0
60 3 1 1 1 0 0 0 1 1 1 1 77 1 50
61 3 2 1 2 0 0 0 1 1 1 0 0
62 3 1 1 2 0 0 0 1 1 1 1 78 0
$EndPartitionedEntities
)";
  std::string text(two_regions_4);
  text.insert(text.find("$Nodes"), parts);
  const MixedMesh whole = parsed(std::string(two_regions_4));
  EXPECT_TRUE(parsed(text) == whole);
  const auto in_part = [](std::string of_whole, std::string_view from, std::string_view to) {
    return of_whole.replace(of_whole.find(from, of_whole.find("$Elements")), from.size(), to);
  };
  text = in_part(text, "\n3 1 4 1\n", "\n3 60 4 1\n");
  text = in_part(text, "\n3 2 4 1\n", "\n3 61 4 1\n");
  EXPECT_TRUE(parsed(in_part(text, "\n2 9 2 1\n", "\n2 50 2 1\n")) == whole);
  EXPECT_EQ(parsed(in_part(text, "\n2 9 2 1\n", "\n2 51 2 1\n")).triangles.size(), 0u);
}

// As Gmsh writes a volume that two groups hold.
TEST(Msh, AnElementOfTwoGroupsCountsOnce) {
  const std::string text = changed(changed(two_tets_2, "$Elements\n4", "$Elements\n6"), "4 2 3 6 2 0",
                                   "5 4 2 8 1 10 7 3000000 8\n6 4 2 8 1 9 7 3000000 8\n4 2 3 6 2 0");
  const MixedMesh mesh = parsed(text);
  EXPECT_THAT(mesh.tets.cells, ElementsAre(Tet{0, 1, 2, 3}, Tet{4, 1, 2, 3}));
  EXPECT_THAT(mesh.tets.tags, ElementsAre(5, 8));
  // The same cell in two entities is not the writer's doing, and stays for the user to see.
  EXPECT_EQ(parsed(changed(text, "5 4 2 8 1", "5 4 2 8 2")).tets.size(), 3u);
}

TEST(Msh, ReadsElementsWithoutTagsAndWithoutEntities) {
  EXPECT_THAT(parsed(changed(two_tets_2, "3 4 2 5 1", "3 4 0")).tets.tags, ElementsAre(0));
  std::string text(two_regions_4);
  const std::size_t begin = text.find("$Entities"), end = text.find("$Nodes");
  EXPECT_THAT(parsed(text.erase(begin, end - begin)).tets.tags, ElementsAre(1, 2));
}

TEST(Msh, SkipsOtherSections) {
  std::string text(two_tets_2);
  text += "$Periodic\n0\n$EndPeriodic\n$NodeData\n1\n\"a $Nodes b\"\n0\n0\n$EndNodeData\n";
  text.insert(text.find("$Nodes"), "$Comments\n anything $ at all\n$EndComments\n");
  EXPECT_TRUE(parsed(text) == parsed(std::string(two_tets_2)));
  EXPECT_THAT(message_of_reading(text + "$Periodic\n0\n"), HasSubstr("expected $EndPeriodic, found end of file"));
}

TEST(Msh, TakesQualitiesFromElementData) {
  const std::string head = "$ElementData\n1\n\"quality\"\n1\n0.0\n3\n0\n1\n";
  EXPECT_THAT(parsed(std::string(two_tets_2) + head + "1\n3 0.5\n$EndElementData\n").tets.quality, ElementsAre(0.5));
  // Another element's, another view, and one of two cells only.
  EXPECT_THAT(parsed(std::string(two_tets_2) + head + "1\n4 0.5\n$EndElementData\n").tets.quality, ElementsAre());
  EXPECT_THAT(
      parsed(std::string(two_tets_2) + changed(head, "quality", "other") + "1\n3 0.5\n$EndElementData\n").tets.quality,
      ElementsAre());
  EXPECT_THAT(parsed(std::string(two_regions_4) + head + "1\n12 0.5\n$EndElementData\n").tets.quality, ElementsAre());
  EXPECT_THAT(parsed(std::string(two_regions_4) + head + "2\n40 0.5 12 0.25\n$EndElementData\n").tets.quality,
              ElementsAre(0.25, 0.5));
}

TEST(Msh, TagsThatAreNoPositiveNumbersAreInTheNamesOfGroups) {
  MixedMesh mesh = one_cell_of_each_kind();
  mesh.hexes.tags = {0};
  mesh.tets.tags = {-4};
  mesh.quads.tags = {-1, 0, 1};
  // In version 2.2 surfaces and regions have numbers apart.
  const std::string text = written(mesh, "msh22");
  for (const char* group : {"3 5 \"region_0\"", "3 4 \"region_-4\"", "3 6 \"region_2\"", "3 7 \"region_3\"",
                            "2 1 \"surface_1\"", "2 2 \"surface_-1\"", "2 3 \"surface_0\""})
    EXPECT_THAT(text, HasSubstr(group));
  for (const char* group : {"3 1 \"region_-4\"", "3 4 \"region_0\"", "3 2 \"region_2\""})
    EXPECT_THAT(written(mesh, "msh"), HasSubstr(group));
  MixedMesh without_quality = mesh;
  drop_quality(without_quality);
  EXPECT_TRUE(parsed(text) == without_quality);
  EXPECT_TRUE(parsed(written(mesh, "msh-binary")) == mesh);
  // Other names do not count: the number of the group is the tag.
  EXPECT_THAT(parsed(changed(text, "region_-4", "region 17")).tets.tags, ElementsAre(4));
  // Nor does a name that tells the number of another group.
  EXPECT_THAT(parsed(changed(text, "region_-4", "region_5")).tets.tags, ElementsAre(4));
  EXPECT_THAT(parsed(changed(text, "region_-4", "steel")).tets.tags, ElementsAre(4));
}

// A binary file in version 4.1 whose sizes have 4 bytes, which Gmsh can be built to write.
TEST(Msh, ReadsSizesOfFourBytes) {
  std::string text = "$MeshFormat\n4.1 1 4\n";
  const auto put = [&](std::initializer_list<std::int32_t> numbers) {
    for (const std::int32_t number : numbers) text.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  const auto put_real = [&](std::initializer_list<double> numbers) {
    for (const double number : numbers) text.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  put({1});
  text += "\n$EndMeshFormat\n$Entities\n";
  put({0, 0, 0, 1, 1});
  put_real({0, 0, 0, 1, 1, 1});
  put({1, 8, 0});
  text += "\n$EndEntities\n$Nodes\n";
  put({1, 4, 1, 4, 3, 1, 0, 4, 1, 2, 3, 4});
  put_real({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  text += "\n$EndNodes\n$Elements\n";
  put({1, 1, 1, 1, 3, 1, 4, 1, 1, 1, 2, 3, 4});
  text += "\n$EndElements\n";
  const MixedMesh mesh = parsed(text);
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_THAT(mesh.tets.cells, ElementsAre(Tet{0, 1, 2, 3}));
  EXPECT_THAT(mesh.tets.tags, ElementsAre(8));
}

TEST(Msh, ReadsParametricNodesOfVersion2) {
  std::string text(two_tets_2);
  text.replace(text.find("$Nodes"), 6, "$ParametricNodes");
  text.replace(text.find("$EndNodes"), 9, "$EndParametricNodes");
  const std::pair<const char*, const char*> lines[] = {{"10 0 0 0\n", "10 0 0 0 0 1\n"},
                                                       {"7 1 0 0\n", "7 1 0 0 1 1 .5\n"},
                                                       {"3000000 0 1 0\n", "3000000 0 1 0 2 1 .5 .5\n"},
                                                       {"8 0 0 1\n", "8 0 0 1 3 1\n"},
                                                       {"9 1 1 1\n", "9 1 1 1 3 1\n"}};
  for (const auto& [from, to] : lines) text = changed(text, from, to);
  EXPECT_TRUE(parsed(text) == parsed(std::string(two_tets_2)));
}

TEST(Msh, TellsTheOtherByteOrder) {
  for (const char* format : {"msh-binary", "msh22-binary"}) {
    std::string bytes = written(one_cell_of_each_kind(), format);
    const std::size_t one = bytes.find('\n', bytes.find("1 8")) + 1;
    std::swap(bytes[one], bytes[one + 3]);
    EXPECT_THAT(message_of_reading(bytes), HasSubstr("expected this machine's byte order, found the other one"));
    bytes[one + 1] = 7;
    EXPECT_THAT(message_of_reading(bytes), HasSubstr("expected the number one"));
  }
}

TEST(Msh, NamesTheLineOfADefectInVersion2) {
  const auto expect = [](std::string_view from, std::string_view to, const std::string& message) {
    EXPECT_EQ(message_of_reading(changed(two_tets_2, from, to)), message);
  };
  expect("2.2 0 8", "4 0 8", "test:2: expected version 2.2 or 4.1 of the format, found '4'");
  expect("2.2 0 8", "2.2 2 8", "test:2: expected 0 (ASCII) or 1 (binary), found '2'");
  expect("2.2 0 8", "2.2 0 16", "test:2: expected a data size of 4 or 8, found '16'");
  expect("8 0 0 1", "7 0 0 1", "test:10: expected each node once, found 7 twice");
  expect("8 0 0 1", "8 0 0 inf", "test:9: expected a coordinate, found 'inf'");
  expect("8 0 0 1", "-8 0 0 1", "test:9: expected the number of a node, found '-8'");
  expect("\n5\n", "\n5000\n", "test:5: expected a number of nodes that the rest of the file can hold, found 5000");
  expect("\n5\n", "\n-5\n", "test:5: expected a number of nodes that the rest of the file can hold, found -5");
  expect("\n5\n", "\n4\n", "test:10: expected $EndNodes, found '9'");
  expect("10 7 3000000 8", "10 7 3000000 11", "test:16: expected the number of a node, found '11'");
  expect("10 7 3000000 8", "10 7 3000000 0", "test:16: expected the number of a node, found '0'");
  expect("3 4 2 5 1 10 7 3000000 8", "3 11 2 5 1 10 7 3000000 8 1 2 3 4 5 6",
         "test:16: expected elements of first order, types 1 to 7 and 15, found type 11");
  expect("3 4 2 5 1", "3 4 -2 5 1", "test:16: expected a number of tags, found '-2'");
  expect("\n4\n", "\n5\n", "test:18: expected the number of an element, found '$EndElements'");
  expect("\n4\n", "\n3\n", "test:17: expected $EndElements, found '4'");
  expect("$Nodes", "$Comments", "test:4: expected $EndComments, found end of file");
  expect("$MeshFormat", "$NOD", "test:1: expected version 2.2 or 4.1 of the format, found '1'");
  expect("$EndElements\n", "$EndElements\nx", "test:19: expected a section, found 'x'");
  EXPECT_THAT(message_of_reading("$Nodes\n1\n1 0 0 0\n$EndNodes\n"), HasSubstr("expected $MeshFormat before $Nodes"));
}

TEST(Msh, NamesTheLineOfADefectInVersion4) {
  const auto expect = [](std::string_view from, std::string_view to, const std::string& message) {
    EXPECT_EQ(message_of_reading(changed(two_regions_4, from, to)), message);
  };
  expect("2 5 1 100", "2 6 1 100", "test:25: expected 6 nodes, found 5");
  expect("2 5 1 100", "2 4 1 100", "test:17: expected 4 nodes, found more");
  expect("4 4 1 40", "4 5 1 40", "test:36: expected 5 elements, found 4");
  expect("4 4 1 40", "4 3 1 40", "test:35: expected 3 elements, found more");
  expect("3 2 4 1\n40", "3 2 4 9999\n40",
         "test:31: expected the number of elements of a block that the rest of the file can hold, found 9999");
  expect("2\n3\n5\n4\n", "2\n3\n5\n5\n", "test:25: expected each node once, found 5 twice");
}

}  // namespace
}  // namespace hexpipe
