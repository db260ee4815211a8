#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "formats/streams/scalar_bytes.hpp"
#include "sample_meshes.hpp"

namespace hexpipe {
using namespace formats;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view legacy_tet = R"(# vtk DataFile Version 2.0
a title
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 float
0 0 0 1 0 0
0 1 0 0 0 1
9 9 9
CELLS 3 12
2 0 1
4 0 1 2 3
3 1 2 3
CELL_TYPES 3
3
10
5
CELL_DATA 3
SCALARS tag int 1
LOOKUP_TABLE default
1
7
-5
)";

std::string legacy_with(std::string_view from, std::string_view to) {
  std::string text(legacy_tet);
  return text.replace(text.find(from), from.size(), to);
}

// The numbers as version 2 to 4 have them in binary: big-endian.
template <class T>
std::string big_endian(std::initializer_list<T> numbers) {
  std::string bytes;
  for (T number : numbers) {
    if (std::endian::native == std::endian::little) number = swap_bytes(number);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  return bytes + "\n";
}

TEST(VtkLegacy, ReadsCellsFacetsAndTags) {
  const MixedMesh mesh = parsed(std::string(legacy_tet));
  EXPECT_EQ(mesh.points.size(), 5u);
  EXPECT_THAT(mesh.tets.cells, ElementsAre(Tet{0, 1, 2, 3}));
  EXPECT_THAT(mesh.tets.tags, ElementsAre(7));
  EXPECT_THAT(mesh.triangles.cells, ElementsAre(Triangle{1, 2, 3}));
  EXPECT_THAT(mesh.triangles.tags, ElementsAre(-5));
}

TEST(VtkLegacy, ReadsBinary) {
  const auto text = [](const std::string& size_of_cells) {
    return "# vtk DataFile Version 3.0\ntitle\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n" +
           big_endian<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 9, 9, 9}) + "CELLS 3 " + size_of_cells + "\n" +
           big_endian<std::int32_t>({2, 0, 1, 4, 0, 1, 2, 3, 3, 1, 2, 3}) + "CELL_TYPES 3\n" +
           big_endian<std::int32_t>({3, 10, 5}) + "CELL_DATA 3\nSCALARS tag short\nLOOKUP_TABLE default\n" +
           big_endian<std::int16_t>({1, 7, -5});
  };
  EXPECT_TRUE(parsed(text("12")) == parsed(std::string(legacy_tet)));
  EXPECT_THAT(message_of_reading(text("11")), HasSubstr("expected a number of corners, found 3"));
  EXPECT_THAT(message_of_reading(text("9")), HasSubstr("expected a number of corners, found 3"));
  EXPECT_THAT(message_of_reading(text("8")), HasSubstr("expected 3 cells, found 2"));
  // Without cell data a file is whole: before and behind the end of the line of cell types.
  const std::string whole = text("12");
  std::vector<std::string> accepted;
  for (std::size_t size = 0; size + 1 < whole.size(); ++size)
    if (message_of_reading(whole.substr(0, size)).empty()) accepted.push_back(whole.substr(size, 10));
  EXPECT_THAT(accepted, ElementsAre("\nCELL_DATA", "CELL_DATA "));
}

TEST(VtkLegacy, ReadsOffsetsAndConnectivity) {
  std::string text = legacy_with("Version 2.0", "Version 5.1");
  const std::size_t begin = text.find("CELLS"), end = text.find("CELL_TYPES");
  text.replace(begin, end - begin,
               "CELLS 4 9\nOFFSETS vtktypeint64\n0 2 6 9\nCONNECTIVITY vtktypeint64\n0 1 0 1 2 3 1 2 3\n");
  EXPECT_TRUE(parsed(text) == parsed(std::string(legacy_tet)));
  const auto message = [&](std::string_view from, std::string_view to) {
    std::string copy = text;
    return message_of_reading(copy.replace(copy.find(from), from.size(), to));
  };
  EXPECT_THAT(message("0 2 6 9", "1 2 6 9"), HasSubstr("expected offsets that begin with 0, found 1"));
  EXPECT_THAT(message("0 2 6 9", "0 6 2 9"), HasSubstr("cell 1: expected an offset of at least 6, found 2"));
  EXPECT_THAT(message("0 2 6 9", "0 2 6 8"), HasSubstr("expected 8 corners of cells as the offsets say, found 9"));
  EXPECT_THAT(message("0 2 6 9", "0 3 6 9"), HasSubstr("cell 1: expected 4 corners of a tet, found 3"));
  EXPECT_THAT(message("0 1 0 1 2 3", "0 1 0 1 2 5"), HasSubstr("cell 1: expected points from 0 to below 5, found 5"));
  EXPECT_THAT(message("OFFSETS", "CONNECTIVITY"), HasSubstr("expected OFFSETS, found 'CONNECTIVITY'"));
}

TEST(VtkLegacy, SkipsOtherData) {
  const std::string text = legacy_with("CELL_DATA 3\n", R"(METADATA
INFORMATION 1
NAME L2_NORM_RANGE LOCATION vtkDataArray
DATA 2 0 2.1

POINT_DATA 5
SCALARS tag int
LOOKUP_TABLE t
0 1 2 3 4
LOOKUP_TABLE t 2
0 0 0 1 1 1 1 1
VECTORS v double
0 0 0 0 0 0 0 0 0 0 0 0 nan 0 0
METADATA
INFORMATION 0

TEXTURE_COORDINATES c 2 float
0 0 0 0 0 0 0 0 0 0
COLOR_SCALARS d 1
0 0 0 0 0
TENSORS t float
0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0
GLOBAL_IDS g vtkIdType
0 1 2 3 4
FIELD FieldData 2
quality 1 5 double
1 1 1 1 1
METADATA
INFORMATION 0

more 2 5 int
0 0 0 0 0 0 0 0 0 0
CELL_DATA 3
SCALARS region int 2
LOOKUP_TABLE default
0 0 0 0 0 0
)");
  EXPECT_TRUE(parsed(text) == parsed(std::string(legacy_tet)));
}

TEST(VtkLegacy, RegionAndSurfaceComeBeforeOtherNames) {
  std::string text(legacy_tet);
  text += "FIELD FieldData 3\nregion 1 3 int\n10 11 12\nsurface 1 3 double\n20 21 22.0\nquality 1 3 float\n1 0.5 1\n";
  const MixedMesh mesh = parsed(text);
  EXPECT_THAT(mesh.tets.tags, ElementsAre(11));
  EXPECT_THAT(mesh.triangles.tags, ElementsAre(22));
  EXPECT_THAT(mesh.tets.quality, ElementsAre(0.5));
  EXPECT_TRUE(mesh.triangles.quality.empty());
  for (const char* name : {"gmsh:physical", "medit:ref", "CellEntityIds"})
    EXPECT_THAT(parsed(legacy_with("SCALARS tag", std::string("SCALARS ") + name)).tets.tags, ElementsAre(7)) << name;
  EXPECT_THAT(parsed(legacy_with("SCALARS tag", "SCALARS other")).tets.tags, ElementsAre(0));
}

TEST(VtkLegacy, TurnsWedgesPixelsAndVoxels) {
  const MixedMesh mesh = parsed(R"(# vtk DataFile Version 4.2
t
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 8 double
0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1
CELLS 3 21
8 0 1 2 3 4 5 6 7
4 0 1 2 3
6 0 2 1 4 6 5
CELL_TYPES 3
11
8
13
)");
  EXPECT_THAT(mesh.hexes.cells, ElementsAre(std::array<Vertex, 8>{0, 1, 3, 2, 4, 5, 7, 6}));
  EXPECT_THAT(mesh.quads.cells, ElementsAre(Quad{0, 1, 3, 2}));
  EXPECT_THAT(mesh.prisms.cells, ElementsAre(std::array<Vertex, 6>{0, 1, 2, 4, 5, 6}));
}

TEST(VtkLegacy, NamesTheLineOfADefect) {
  const auto expect = [](std::string_view from, std::string_view to, const std::string& message) {
    EXPECT_EQ(message_of_reading(legacy_with(from, to)), message);
  };
  expect("2.0", "6.0", "test:1: expected a version from 1.0 to 5.1, found another");
  expect("ASCII", "TEXT", "test:3: expected ASCII or BINARY, found 'TEXT'");
  expect("UNSTRUCTURED_GRID", "FIELD", "test:4: expected UNSTRUCTURED_GRID or POLYDATA, found 'FIELD'");
  expect("POINTS 5", "POINTS 5000",
         "test:5: expected the number of points that the rest of the file can hold, found 5000");
  expect("POINTS 5", "POINTS 4", "test:8: expected POINTS, CELLS, CELL_TYPES, CELL_DATA or POINT_DATA, found '9'");
  expect("POINTS 5 float", "POINTS 5 string", "test:5: expected a type of numbers, found 'string'");
  expect("9 9 9", "9 nan 9", "test:8: expected a coordinate, found 'nan'");
  expect("4 0 1 2 3", "4 0 1 2 5", "test:11: expected a point from 0 to below 5, found '5'");
  expect("4 0 1 2 3", "4 0 1 2 -1", "test:11: expected a point from 0 to below 5, found '-1'");
  expect("4 0 1 2 3", "5 0 1 2 3 4", "test:12: expected 12 numbers for the cells, found 13");
  expect("CELLS 3 12", "CELLS 3 11", "test:12: expected 11 numbers for the cells, found 12");
  expect("CELL_TYPES 3", "CELL_TYPES 2",
         "test:16: expected POINTS, CELLS, CELL_TYPES, CELL_DATA or POINT_DATA, found '5'");
  expect("\n10\n", "\n24\n", "test: cell 1: expected a linear cell of VTK type 5, 9, 10, 12, 13 or 14, found type 24");
  expect("\n10\n", "\n12\n", "test: cell 1: expected 8 corners of a hex, found 4");
  expect("CELL_DATA 3", "CELL_DATA 4", "test:17: expected 3 entries, found '4'");
  expect("\n7\n", "\n7.5\n", "test:21: expected a tag of tag, found '7.5'");
  expect("int 1", "double 1", "");
  expect("\n7\n", "\nx\n", "test:21: expected a tag of tag, found 'x'");
  expect("-5\n", "-5", "test: expected the last line to have an end, found none; is the file cut off?");
  expect("SCALARS tag int 1", "SPECTRA tag int 1", "test:18: expected a size, found 'int'");
  expect("CELLS", "LINES", "test:9: expected POINTS, CELLS, CELL_TYPES, CELL_DATA or POINT_DATA, found 'LINES'");
}

// As VTK 9 writes points, a polygon of five corners with a concave one, a triangle, and a strip.
TEST(VtkLegacy, PolygonsAndStripsBecomeTrianglesAndQuads) {
  const std::string head =
      "# vtk DataFile Version 5.1\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 6 float\n"
      "0 0 0 2 0 0 2 2 0 1 .5 0 0 2 0 0 0 1\n";
  const std::string offsets = "OFFSETS vtktypeint64\n", corners = "CONNECTIVITY vtktypeint64\n";
  const std::string body = "VERTICES 2 1\n" + offsets + "0 1\n" + corners + "0\nTRIANGLE_STRIPS 2 4\n" + offsets +
                           "0 4\n" + corners + "0 1 2 5\nPOLYGONS 4 12\n" + offsets + "0 5 8 12\n" + corners +
                           "0 1 2 3 4 0 1 5 0 1 2 4\n";
  const std::string data = "CELL_DATA 5\nSCALARS surface int\nLOOKUP_TABLE default\n10 20 30 40 50\n";
  const MixedMesh mesh = parsed(head + body + data);
  EXPECT_THAT(mesh.triangles.tags, ElementsAre(20, 20, 20, 30, 50, 50));
  EXPECT_THAT(mesh.quads.tags, ElementsAre(40));
  EXPECT_THAT(mesh.quads.cells, ElementsAre(std::array<Vertex, 4>{0, 1, 2, 4}));
  EXPECT_EQ(mesh.triangles.cells[4], (Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.triangles.cells[5], (Triangle{2, 1, 5}));
  double area = 0;  // of the concave polygon; a fan would turn one of its triangles over
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [a, b, c] = mesh.triangles.cells[i];
    const double part = cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]).z / 2;
    EXPECT_GT(part, 0);
    area += part;
  }
  EXPECT_DOUBLE_EQ(area, 2.5);
  EXPECT_EQ(message_of_reading(head + body + "CELL_DATA 4\n"), "test:22: expected 5 entries, found '4'");
  EXPECT_EQ(message_of_reading(head + body + "CELLS 0 0\n"),
            "test:22: expected POINTS, POLYGONS, TRIANGLE_STRIPS, CELL_DATA or POINT_DATA, found 'CELLS'");
  // As older versions write it, each cell with its number of corners.
  std::string old = head + "POLYGONS 1 4\n3 0 1 5\nPOLYGONS 1 4\n3 0 1 5\n";
  old.replace(old.find("5.1"), 3, "3.0");
  EXPECT_EQ(message_of_reading(old), "test:9: expected one section POLYGONS, found a second");
  EXPECT_THAT(parsed(old.substr(0, old.rfind("POLYGONS"))).triangles.cells, ElementsAre(Triangle{0, 1, 5}));
}

}  // namespace
}  // namespace hexpipe
