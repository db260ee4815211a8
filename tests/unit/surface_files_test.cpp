#include "formats/surfaces/surface_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "common/run/error.hpp"

namespace hexpipe {
using namespace formats;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

SurfaceSoup read(const std::string& bytes) {
  Input input = Input::from_memory(bytes, "part");
  return read_surface(input);
}

std::string error_of(const std::string& bytes) {
  try {
    read(bytes);
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

template <class T>
void append(std::string& bytes, T value, bool swap = false) {
  std::string raw(sizeof value, '\0');
  std::memcpy(raw.data(), &value, sizeof value);
  if (swap) std::ranges::reverse(raw);
  bytes += raw;
}

// The tet (0,0,0) (1,0,0) (0,1,0) (0,0,1), outward.
const std::vector<Vec3> tet_points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<Triangle> tet_triangles{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

// The same surface in every format. STL numbers points as facets meet them.
void expect_tet(const SurfaceSoup& soup) {
  ASSERT_EQ(soup.points.size(), 4u);
  ASSERT_EQ(soup.triangles.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t corner = 0; corner < 3; ++corner)
      EXPECT_EQ(soup.points[soup.triangles[i][corner]], tet_points[tet_triangles[i][corner]]);
}

std::string ascii_stl() {
  std::string text = "solid tet\n";
  for (const Triangle& t : tet_triangles) {
    text += "  facet normal 0 0 nan\n    outer loop\n";
    for (const Vertex v : t)
      text += fmt::format("      vertex {} {:.1e} {}\n", tet_points[v].x, tet_points[v].y, tet_points[v].z);
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid tet\n";
}

std::string binary_stl(const std::string& header = "any header") {
  std::string bytes = header;
  bytes.resize(80, '\0');
  append(bytes, static_cast<std::uint32_t>(tet_triangles.size()));
  for (std::size_t i = 0; i < tet_triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) append(bytes, 0.0f);
    for (const Vertex v : tet_triangles[i])
      for (int axis = 0; axis < 3; ++axis) append(bytes, static_cast<float>(tet_points[v][axis]));
    append(bytes, static_cast<std::uint16_t>(7 * (i % 2)));
  }
  return bytes;
}

std::string obj() {
  return "# a tet\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\ns off\n"
         "f 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\nf -3 -2 \\\n  -1\nf 1/1 4/1 3/1\n";
}

std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by hand\nobj_info none\n"
         "element vertex 4\nproperty float x\nproperty uchar red\nproperty double y\nproperty float32 z\n"
         "element material 2\nproperty list uchar short codes\n"
         "element face 4\nproperty int16 flags\nproperty list uchar int vertex_indices\nproperty list int uint8 "
         "texture\n"
         "element nothing 1000000000000\nend_header\n";
}

std::string ascii_ply() {
  std::string text = ply_header("ascii");
  for (const Vec3& p : tet_points) text += fmt::format("{} 255 {} {}\n", p.x, p.y, p.z);
  text += "0\n2 -5 6\n";
  for (const Triangle& t : tet_triangles) text += fmt::format("-1 3 {} {} {} 2 1 1\n", t[0], t[1], t[2]);
  return text;
}

std::string binary_ply(bool big_endian) {
  const bool swap = big_endian == (std::endian::native == std::endian::little);
  std::string bytes = ply_header(big_endian ? "binary_big_endian" : "binary_little_endian");
  for (const Vec3& p : tet_points) {
    append(bytes, static_cast<float>(p.x), swap);
    append(bytes, std::uint8_t{255}, swap);
    append(bytes, p.y, swap);
    append(bytes, static_cast<float>(p.z), swap);
  }
  append(bytes, std::uint8_t{0}, swap);
  append(bytes, std::uint8_t{2}, swap);
  append(bytes, std::int16_t{-5}, swap), append(bytes, std::int16_t{6}, swap);
  for (const Triangle& t : tet_triangles) {
    append(bytes, std::int16_t{-1}, swap);
    append(bytes, std::uint8_t{3}, swap);
    for (const Vertex v : t) append(bytes, v, swap);
    append(bytes, std::int32_t{1}, swap);
    append(bytes, std::uint8_t{9}, swap);
  }
  return bytes;
}

std::string off() {
  return "# a tet\nOFF\n4 4 # no count of edges\n\n0 0 0\n1 0 0 # right\n0 1 0\n0 0 1\n"
         "3 0 2 1\n3 0 1 3 255 0 0\n3 1 2 3\n3 0 3 2\n";
}

std::string coff() {
  return "COFF 4 4 6\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n0 0 1 1 1 1 1\n"
         "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}

TEST(SurfaceFiles, ReadsTheSameSurfaceFromEveryFormat) {
  for (const std::string& bytes :
       {ascii_stl(), binary_stl(), obj(), ascii_ply(), binary_ply(false), binary_ply(true), off(), coff()})
    expect_tet(read(bytes));
}

TEST(SurfaceFiles, TakesABinaryStlWhoseHeaderSaysSolid) {
  expect_tet(read(binary_stl("solid but binary")));
}

TEST(SurfaceFiles, TakesDosLineEndsAndKeywordsInAnyCase) {
  std::string text;
  for (const char c : ascii_stl())
    text += c == '\n' ? std::string("\r\n") : std::string(1, static_cast<char>(std::toupper(c)));
  expect_tet(read(text));
  std::string dos;
  for (const char c : ascii_ply()) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_tet(read(dos));
}

TEST(SurfaceFiles, PlacesAreLinesOfTextAndNumbersInBinaryFiles) {
  EXPECT_THAT(read(ascii_stl()).places, ElementsAre(2, 9, 16, 23));
  EXPECT_THAT(read(binary_stl()).places, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(read(obj()).places, ElementsAre(10, 11, 12, 14));
  EXPECT_THAT(read(off()).places, ElementsAre(9, 10, 11, 12));
  EXPECT_THAT(read(binary_ply(true)).places, ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(read(ascii_stl()).place_of(1), "part:9");
  EXPECT_EQ(read(binary_stl()).place_of(1), "part: triangle 2");
}

TEST(SurfaceFiles, TagsAreSolidsAttributesAndGroups) {
  EXPECT_THAT(read(ascii_stl()).tags, ElementsAre(1, 1, 1, 1));
  EXPECT_THAT(read(ascii_stl() + ascii_stl()).tags, ElementsAre(1, 1, 1, 1, 2, 2, 2, 2));
  EXPECT_THAT(read(binary_stl()).tags, ElementsAre(0, 7, 0, 7));
  EXPECT_THAT(read(obj()).tags, ElementsAre(0, 0, 0, 0));
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_THAT(read(vertices + "f 1 2 3\no empty\ng top\nf 1 2 3\ng bottom\nf 1 2 3\ng top\nf 1 2 3\n").tags,
              ElementsAre(0, 1, 2, 1));
}

TEST(SurfaceFiles, BlanksAroundTheNameOfAGroupSayNothing) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", face = "\nf 1 2 3\n";
  EXPECT_THAT(read(vertices + "g top" + face + "g  top \t" + face + "g top\r" + face + "g top # again" + face).tags,
              ElementsAre(1, 1, 1, 1));
}

TEST(SurfaceFiles, ANumberSignWithinAWordIsPartOfTheNameOfAGroup) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n", face = "\nf 1 2 3\n";
  EXPECT_THAT(read(vertices + "g Face#1" + face + "g Face#2" + face + "g Face#1 # again" + face).tags,
              ElementsAre(1, 2, 1));
}

TEST(SurfaceFiles, TakesAByteOrderMarkBeforeText) {
  for (const std::string& text : {ascii_stl(), obj(), ascii_ply(), off()}) expect_tet(read("\xef\xbb\xbf" + text));
}

TEST(SurfaceFiles, RemarksMayComeBeforeTheFormatOfPly) {
  std::string text = ascii_ply();
  text.insert(text.find("format"), "comment by hand\nobj_info 1\n");
  expect_tet(read(text));
}

TEST(SurfaceFiles, FansPolygons) {
  const SurfaceSoup soup = read("OFF 5 1 0\n0 0 0\n2 0 0\n3 1 0\n2 2 0\n0 2 0\n5 0 1 2 3 4\n");
  EXPECT_THAT(soup.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}));
  EXPECT_THAT(soup.places, ElementsAre(7, 7, 7));
}

// Twice the area of the triangles, none of which may be turned over or flat, of points in the plane z = 0.
double double_area(const SurfaceSoup& soup) {
  double sum = 0;
  for (const auto& [a, b, c] : soup.triangles) {
    const double area = cross(soup.points[b] - soup.points[a], soup.points[c] - soup.points[a]).z;
    EXPECT_GT(area, 0);
    sum += area;
  }
  return sum;
}

std::string obj_of_polygon(const std::vector<Vec3>& corners, std::size_t first = 0) {
  std::string vertices, face = "f";
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& p = corners[(first + i) % corners.size()];
    vertices += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    face += fmt::format(" {}", i + 1);
  }
  return face + "\n" + vertices;
}

TEST(SurfaceFiles, CutsConcavePolygonsWhereverTheyBegin) {
  const std::vector<Vec3> corner{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  const std::vector<Vec3> comb{{0, 0, 0}, {7, 0, 0}, {7, 5, 0}, {6, 5, 0}, {6, 1, 0}, {5, 1, 0}, {5, 5, 0},
                               {4, 5, 0}, {4, 1, 0}, {2, 1, 0}, {2, 3, 0}, {1, 3, 0}, {1, 1, 0}, {0, 1, 0}};
  // A square with a square hole, to which a bridge leads.
  const std::vector<Vec3> ring{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0},
                               {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
  for (const auto& [polygon, area] : {std::pair(corner, 3.0), {comb, 17.0}, {ring, 8.0}})
    for (std::size_t first = 0; first < polygon.size(); ++first) {
      const SurfaceSoup soup = read(obj_of_polygon(polygon, first));
      EXPECT_EQ(soup.triangles.size(), polygon.size() - 2) << first;
      EXPECT_DOUBLE_EQ(double_area(soup), 2 * area) << first;
    }
}

TEST(SurfaceFiles, CutsConcavePolygonsOfOffAndPly) {
  const std::string points = "1 1 0\n1 2 0\n0 2 0\n0 0 0\n2 0 0\n2 1 0\n", face = "6 1 2 3 4 5 0\n";
  const std::string header = "ply\nformat ascii 1.0\n", of_vertices =
                                                            "element vertex 6\nproperty double x\n"
                                                            "property double y\nproperty double z\n";
  const std::string of_faces = "element face 1\nproperty list uchar int vertex_indices\n";
  EXPECT_DOUBLE_EQ(double_area(read("OFF 6 1 0\n" + points + face)), 6);
  EXPECT_DOUBLE_EQ(double_area(read(header + of_vertices + of_faces + "end_header\n" + points + face)), 6);
  EXPECT_DOUBLE_EQ(double_area(read(header + of_faces + of_vertices + "end_header\n" + face + points)), 6);
}

TEST(SurfaceFiles, APolygonThatCrossesItselfStaysAFan) {
  EXPECT_THAT(read(obj_of_polygon({{0, 0, 0}, {2, 2, 0}, {3, 0, 0}, {0, 2, 0}, {9, 9, 0}, {1, -9, 0}})).triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}, Triangle{0, 4, 5}));
}

TEST(SurfaceFiles, APolygonOfThousandsOfCornersTakesNoTime) {
  // A gear: each second corner further in, half of them concave.
  const auto gear = [](int count) {
    std::vector<Vec3> corners;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count, radius = i % 2 == 0 ? 1 : 0.9;
      corners.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    return corners;
  };
  EXPECT_NEAR(double_area(read(obj_of_polygon(gear(10000), 1))), 0.9 * 2 * std::numbers::pi, 1e-5);
  EXPECT_EQ(read(obj_of_polygon(gear(200000))).triangles[7], (Triangle{0, 8, 9}));
}

TEST(SurfaceFiles, MergesEqualPointsAndDropsUnusedOnes) {
  const SurfaceSoup soup = read("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 1 0 0\nv 0 0 1\nf 2 3 4\nf 5 6 7\n");
  EXPECT_EQ(soup.points.size(), 4u);
  EXPECT_THAT(soup.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 3}));
  EXPECT_FALSE(std::signbit(soup.points[0].x));
}

TEST(SurfaceFiles, ForwardReferencesOfObjAreLegal) {
  EXPECT_EQ(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles.size(), 1u);
}

// A cut may take these and leave the file whole: the last digits of the last number, white space, and words without
// meaning.
void expect_every_prefix_rejected(const std::string& bytes, std::size_t harmless) {
  for (std::size_t length = 0; length + harmless < bytes.size(); ++length)
    EXPECT_NE(error_of(bytes.substr(0, length)), "no error") << length << " of " << bytes.size() << " bytes";
}

TEST(SurfaceFiles, RejectsEveryTruncatedPrefix) {
  expect_every_prefix_rejected(ascii_stl(), std::string(" tet\n").size());
  expect_every_prefix_rejected(binary_stl(), 0);
  expect_every_prefix_rejected(binary_stl("solid but binary"), 0);
  expect_every_prefix_rejected(ascii_ply(), 1);
  expect_every_prefix_rejected(binary_ply(false), 0);
  expect_every_prefix_rejected(binary_ply(true), 0);
  expect_every_prefix_rejected(off(), 1);
  expect_every_prefix_rejected(coff(), 1);
}

// OBJ announces no counts: a cut between two faces leaves a surface that is merely open.
TEST(SurfaceFiles, ATruncatedObjHasFewerTriangles) {
  const std::string text = obj();
  for (std::size_t length = 0; length + 3 < text.size(); ++length) {  // "/1" says nothing to us
    Input input = Input::from_memory(text.substr(0, length), "part");
    try {
      EXPECT_LT(read_surface(input).triangles.size(), 4u) << length << " of " << text.size() << " bytes";
    } catch (const DataError&) {
    }
  }
}

TEST(SurfaceFiles, RejectsWhatFollowsTheEnd) {
  EXPECT_THAT(error_of(ascii_stl() + "x"), HasSubstr("part:31: expected solid, found 'x'"));
  EXPECT_THAT(error_of(ascii_ply() + "x"), HasSubstr("expected the end of the file, found 'x'"));
  EXPECT_THAT(error_of(binary_ply(true) + "x"), HasSubstr("expected the end of the file, found 1 more bytes"));
  EXPECT_THAT(error_of(off() + "x"), HasSubstr("part:13: expected the end of the file after 4 faces, found 'x'"));
}

TEST(SurfaceFiles, TellsOfBytesBehindABinaryStl) {
  for (const char* header : {"any header", "solid but binary"}) {
    expect_tet(read(binary_stl(header) + "x"));
    EXPECT_THAT(read(binary_stl(header) + "x").warnings,
                ElementsAre("part: left out 1 byte behind the last of 4 facets"));
    EXPECT_THAT(read(binary_stl(header) + std::string(228, '\0')).warnings,
                ElementsAre("part: left out 228 bytes behind the last of 4 facets"));
  }
  // Blanks fill the header: only the count has zeros.
  expect_tet(read(binary_stl("solid" + std::string(75, ' ')) + "\r\n"));
  EXPECT_THAT(read(binary_stl()).warnings, ElementsAre());
}

TEST(SurfaceFiles, TheHeaderOfABinaryStlMayCountNothing) {
  std::string stl = binary_stl();
  stl.replace(80, 4, 4, '\0');
  expect_tet(read(stl));
  EXPECT_THAT(read(stl).warnings, ElementsAre("part: the header counts 0 facets, the length is that of 4"));
  stl[80] = 3;
  EXPECT_EQ(error_of(stl), "part: expected 3 facets of binary STL as the header says, found 4");
  stl[80] = 5;
  EXPECT_EQ(error_of(stl), "part: expected 334 bytes of binary STL for 5 facets, found 284");
}

TEST(SurfaceFiles, ABlankMayStandInTheEndsOfAsciiStl) {
  std::string text = ascii_stl();
  for (const char* word : {"loop", "facet", "solid"})
    for (std::size_t at = 0; (at = text.find(std::string("end") + word, at)) != std::string::npos; at += 3)
      text.insert(at + 3, " ");
  expect_tet(read(text));
  EXPECT_THAT(read(text + text).tags, ElementsAre(1, 1, 1, 1, 2, 2, 2, 2));
  EXPECT_EQ(error_of(text.substr(0, text.rfind("solid"))), "part:30: expected 'facet' or 'endsolid', found 'end'");
}

TEST(SurfaceFiles, TakesLinesThatEndInCarriageReturnsAlone) {
  for (std::string text : {ascii_stl(), ascii_ply(), off()}) {
    std::ranges::replace(text, '\n', '\r');
    expect_tet(read(text));
  }
  std::string text = "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 x\r";
  EXPECT_EQ(error_of(text), "part:4: expected a vertex index, found 'x'");
}

TEST(SurfaceFiles, TheKeywordOfOffMayTouchItsFirstNumber) {
  std::string text = coff();
  expect_tet(read(text.erase(text.find(' '), 1)));
  EXPECT_EQ(error_of("OFF8x 6 12\n"), "part: expected a surface in STL, OBJ, PLY, OFF or 3MF, found 'OFF8x'");
  EXPECT_EQ(error_of("4OFF4 4 6\n0 0 0 0\n"), "part:1: expected OFF in three dimensions, found '4OFF'");
}

std::string utf16(std::string_view text, bool little) {
  std::string bytes = little ? "\xff\xfe" : "\xfe\xff";
  for (const char c : text) {
    if (!little) bytes += '\0';
    bytes += c;
    if (little) bytes += '\0';
  }
  return bytes;
}

TEST(SurfaceFiles, TakesTextInUtf16) {
  for (const bool little : {true, false}) {
    for (const std::string& text : {ascii_stl(), ascii_ply(), obj(), off()}) expect_tet(read(utf16(text, little)));
    const std::string bytes = utf16(obj(), little);
    EXPECT_EQ(error_of(bytes.substr(0, bytes.size() - 1)),
              "part: expected UTF-16 of two bytes a letter, found an odd number of bytes; is it cut off?");
  }
  EXPECT_EQ(error_of("\xff\xfeo"),
            "part: expected UTF-16 of two bytes a letter, found an odd number of bytes; is it cut off?");
}

TEST(SurfaceFiles, NamesOfOtherFilesAreTold) {
  const auto kind_of = [](const std::string& bytes) {
    const std::string start = "part: expected a surface in STL, OBJ, PLY, OFF or 3MF, found ",
                      message = error_of(bytes);
    EXPECT_THAT(message, HasSubstr(start));
    return message.substr(std::min(start.size(), message.size()));
  };
  const std::string zeros(200, '\0');
  EXPECT_EQ(kind_of("PK\3\4" + zeros + "part.stl" + zeros), "a zip archive; unpack it first");
  EXPECT_EQ(kind_of("%PDF-1.7\n" + zeros), "a PDF document");
  EXPECT_EQ(kind_of("<!DOCTYPE HTML>\n<html>"), "a web page (HTML); was a page saved in place of the file?");
  EXPECT_EQ(kind_of("<?xml version='1.0'?>\n<!-- a part -->\n<COLLADA>"),
            "a COLLADA file (.dae); export it as STL or OBJ");
  EXPECT_EQ(kind_of("{\"asset\": {\"version\": \"2.0\"}}"), "a glTF file; export it as STL or OBJ");
  EXPECT_EQ(kind_of("[{\"a\": 1}]"), "a text in JSON");
  EXPECT_EQ(kind_of("glTF\2" + zeros), "a binary glTF file (.glb); export it as STL or OBJ");
  EXPECT_EQ(kind_of("version https://git-lfs.github.com/spec/v1\n"),
            "a pointer of Git LFS; 'git lfs pull' fetches the file itself");
  EXPECT_EQ(kind_of("  0\nSECTION\n"), "a drawing in DXF; export it as STEP or STL");
  EXPECT_EQ(kind_of("    -1\n  2411\n"), "a universal file (I-deas .unv); meshio or Gmsh can convert it");
  EXPECT_EQ(kind_of("(0 \"Fluent\")\n"), "a Fluent mesh; Fluent and Gmsh export other formats");
  EXPECT_EQ(kind_of("ISO-10303-21;\nHEADER;\n"), "CAD in STEP; 'tessellate part | tetmesh' meshes it");
  EXPECT_EQ(kind_of(std::string(72, ' ') + "S      1\n" + zeros), "CAD in IGES; 'tessellate part | tetmesh' meshes it");
  EXPECT_EQ(kind_of(std::string("\x93what\0ever", 10) + std::string(300, '\xee')), "a binary file of another kind");
}

TEST(SurfaceFiles, RejectsCoordinatesThatAreNotFinite) {
  std::string stl = binary_stl();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(&stl[84 + 50 + 16], &nan, sizeof nan);
  EXPECT_THAT(error_of(stl), HasSubstr("part: triangle 2: expected coordinates up to 1e+50, found 0, nan, 0"));
  EXPECT_EQ(error_of("v 0 0 0\nv 0 nan 0\n"), "part:2: expected a finite coordinate, found 'nan'");
  EXPECT_THAT(error_of("OFF 3 1 0\n0 0 0\n1 0 0\n0 1e51 0\n3 0 1 2\n"),
              HasSubstr("part: expected coordinates up to 1e+50, found 1e+51; scale the surface"));
  EXPECT_EQ(error_of("v 0 0 0\nv 0 0 1e999\n"), "part:2: expected a finite coordinate, found '1e999'");
  std::string ply = binary_ply(false);
  const double infinity = std::numeric_limits<double>::infinity();
  std::memcpy(&ply[ply_header("binary_little_endian").size() + 17 + 5], &infinity, sizeof infinity);
  EXPECT_EQ(error_of(ply), "part: vertex 2: expected coordinates up to 1e+50, found others");
}

TEST(SurfaceFiles, RejectsBadIndicesOfObj) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(error_of(vertices + "f 0 1 2\n"),
            "part:4: expected a vertex index, counted from 1 or back from -1, found '0'");
  EXPECT_EQ(error_of(vertices + "f 1 2 4\n"), "part:4: expected a vertex index up to 3, found 4");
  EXPECT_EQ(error_of(vertices + "f 1 2 -4\n"), "part:4: expected a vertex index among the 3 so far, found '-4'");
  EXPECT_EQ(error_of(vertices + "f 1 2 x/1\n"), "part:4: expected a vertex index, found 'x/1'");
  EXPECT_EQ(error_of(vertices + "f 1 2 99999999999999999999\n"),
            "part:4: expected a vertex index, found '99999999999999999999'");
  EXPECT_EQ(error_of(vertices + "f 1 2\n"), "part:4: expected a face of three or more vertices, found 2");
  EXPECT_EQ(error_of(vertices + "f 1 2 3\ncurv 1 2 3\n"), "part:5: expected an OBJ statement, found 'curv'");
  EXPECT_EQ(error_of("v 1 2\nv 1 2 3\n"), "part:1: expected a finite coordinate, found the end of the line");
}

TEST(SurfaceFiles, RejectsCountsThatTheFileCannotHold) {
  EXPECT_THAT(error_of("OFF\n1000000000000 1 0\n0 0 0\n"), HasSubstr("part:2: expected the number of vertices"));
  EXPECT_THAT(error_of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n"), HasSubstr("part:6:"));
  const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
  const std::string binary = "ply\nformat binary_little_endian 1.0\n";
  EXPECT_THAT(error_of(binary + "element vertex 2147483647\n" + vertex + "end_header\n"),
              HasSubstr("part: expected at most 0 elements 'vertex' in the rest of the file"));
  for (const char* count : {"2147483648", "18446744073709551615"})
    EXPECT_THAT(error_of(binary + "element vertex " + count + "\n" + vertex + "end_header\n"),
                HasSubstr(std::string("part: expected fewer than 2^31 points, found ") + count));
  EXPECT_THAT(error_of("ply\nformat ascii 1.0\nelement vertex 3\n" + vertex +
                       "element face 1\nproperty list int int vertex_index\nend_header\n"
                       "0 0 0\n1 0 0\n0 1 0\n1000000000 0 1 2\n"),
              HasSubstr("part:13: expected a list that the rest of the file can hold, found a length of 1000000000"));
}

TEST(SurfaceFiles, RejectsBadPly) {
  const std::string vertex = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string ascii = "ply\nformat ascii 1.0\n";
  EXPECT_THAT(error_of("ply\nformat text 1.0\n"), HasSubstr("part:2: expected ascii, binary_little_endian or"));
  EXPECT_THAT(error_of(ascii + "property float x\n"), HasSubstr("part:3: expected 'element', 'property'"));
  EXPECT_THAT(error_of(ascii + "element vertex 1\nproperty complex x\n"),
              HasSubstr("expected a PLY type, found 'complex'"));
  EXPECT_THAT(error_of(ascii + "element vertex 1\nproperty float x\nend_header\n1\n"),
              HasSubstr("expected a property y"));
  EXPECT_THAT(error_of(ascii + vertex + "end_header\n0 0 0\n"), HasSubstr("found no triangles"));
  EXPECT_THAT(
      error_of(ascii + vertex + "element face 1\nproperty list uchar float vertex_index\nend_header\n0 0 0\n3 0 0 0\n"),
      HasSubstr("expected a list of integers"));
  EXPECT_THAT(
      error_of(ascii + vertex + "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n3 0 0 1\n"),
      HasSubstr("part:11: expected a vertex index below 1, found 1"));
}

TEST(SurfaceFiles, RejectsOtherOff) {
  EXPECT_THAT(error_of("4OFF\n1 1 1\n"), HasSubstr("part:1: expected OFF in three dimensions, found '4OFF'"));
  EXPECT_THAT(error_of("OFF BINARY\n"), HasSubstr("part:1: expected ASCII OFF, found 'BINARY'"));
  EXPECT_THAT(error_of("OFF 3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
              HasSubstr("part:5: expected a vertex index below 3"));
  EXPECT_THAT(error_of("OFF 3 1\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), HasSubstr("part:3: expected a finite coordinate"));
}

TEST(SurfaceFiles, RejectsWhatIsNoSurface) {
  EXPECT_THAT(error_of(""), HasSubstr("it is empty"));
  EXPECT_THAT(error_of("# only a comment\n"), HasSubstr("found no triangles"));
  EXPECT_THAT(error_of("hello\n"), HasSubstr("expected a surface in STL, OBJ, PLY, OFF or 3MF, found 'hello'"));
  EXPECT_THAT(error_of("solid empty\nendsolid\n"), HasSubstr("found no triangles"));
  EXPECT_THAT(error_of(std::string(300, '\0')), HasSubstr("found a binary file of another kind"));
}

}  // namespace
}  // namespace hexpipe
