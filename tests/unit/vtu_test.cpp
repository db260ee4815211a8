#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>

#include "formats/meshes/vtu.hpp"
#include "formats/streams/base64.hpp"
#include "formats/streams/scalar_bytes.hpp"
#include "sample_meshes.hpp"

namespace hexpipe {
using namespace formats;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view one_tet = R"(<?xml version="1.0"?>
<!-- <VTKFile> -->
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
  <UnstructuredGrid>
    <Piece NumberOfPoints="5" NumberOfCells="3">
      <PointData><DataArray type="Float64" Name="quality" format="ascii">nan</DataArray></PointData>
      <CellData Scalars="tag">
        <DataArray type="Int64" Name="tag" format="ascii">1 7 -5</DataArray>
        <DataArray type="Float64" Name="normals" NumberOfComponents="3" format="ascii">1 2 3</DataArray>
      </CellData>
      <Points>
        <DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">
          0 0 0 1 0 0 0 1 0
          0 0 1 9 9 9
          <InformationKey name="L2_NORM_RANGE" location="vtkDataArray" length="2"/>
        </DataArray>
      </Points>
      <Cells>
        <DataArray type="Int32" Name="connectivity" format="ascii">0 1 0 1 2 3 1 2 3</DataArray>
        <DataArray type="Int32" Name="offsets" format="ascii">2 6 9</DataArray>
        <DataArray type="UInt8" Name="types" format="ascii">3 10 5</DataArray>
      </Cells>
    </Piece>
  </UnstructuredGrid>
</VTKFile>
)";

std::string changed(std::string_view from, std::string_view to) {
  std::string text(one_tet);
  return text.replace(text.find(from), from.size(), to);
}

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return out.substr(0, size);
}

// How a file may hold its data.
struct Layout {
  bool appended, as_base64, long_header, compressed, big_endian;
};

// The mesh of one_tet in a layout, in two compressed blocks an array.
class LaidOut {
 public:
  explicit LaidOut(const Layout& layout) : layout_(layout) {}

  std::string text() {
    std::string xml = fmt::format(
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"{}\"{}>"
        "<UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"3\"><Points>",
        layout_.big_endian ? "BigEndian" : "LittleEndian", layout_.long_header ? "UInt64" : "UInt32",
        layout_.compressed ? " compressor=\"vtkZLibDataCompressor\"" : "");
    xml += array<float>("Float32", "p", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 9, 9, 9}, 3) + "</Points><Cells>";
    xml += array<std::int64_t>("Int64", "connectivity", {0, 1, 0, 1, 2, 3, 1, 2, 3}, 1);
    xml += array<std::uint16_t>("UInt16", "offsets", {2, 6, 9}, 1);
    xml += array<std::uint8_t>("UInt8", "types", {3, 10, 5}, 1) + "</Cells><CellData>";
    xml += array<double>("Float64", "tag", {1, 7, -5}, 1) + "</CellData></Piece></UnstructuredGrid>\n";
    if (layout_.appended)
      xml += fmt::format("<AppendedData encoding=\"{}\">\n _{}</AppendedData>", layout_.as_base64 ? "base64" : "raw",
                         appended_);
    return xml + "</VTKFile>";
  }

 private:
  template <class T>
  std::string bytes(T number) const {
    if ((std::endian::native == std::endian::big) != layout_.big_endian) number = swap_bytes(number);
    return {reinterpret_cast<const char*>(&number), sizeof number};
  }
  std::string length(std::size_t number) const {
    return layout_.long_header ? bytes<std::uint64_t>(number) : bytes(static_cast<std::uint32_t>(number));
  }
  std::string coded(const std::string& data) const { return layout_.as_base64 ? base64(data) : data; }

  template <class T>
  std::string array(const char* type, const char* name, const std::vector<T>& numbers, int components) {
    std::string data;
    for (const T number : numbers) data += bytes(number);
    const std::string encoded = layout_.compressed ? compressed(data) : coded(length(data.size()) + data);
    const std::string head =
        fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" ", type, name, components);
    if (!layout_.appended) return head + "format=\"binary\">\n " + encoded + "\n</DataArray>";
    const std::size_t offset = appended_.size();
    appended_ += encoded;
    return head + fmt::format("format=\"appended\" offset=\"{}\"/>", offset);
  }

  std::string compressed(const std::string& data) const {
    const std::size_t block = data.size() / 2 + 1;
    const std::string first = deflated(data.substr(0, block)), second = deflated(data.substr(block));
    return coded(length(2) + length(block) + length(data.size() - block) + length(first.size()) +
                 length(second.size())) +
           coded(first + second);
  }

  Layout layout_;
  std::string appended_;
};

std::vector<Layout> all_layouts() {
  std::vector<Layout> layouts;
  for (int bits = 0; bits < 32; ++bits) {
    const Layout layout{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0};
    if (layout.appended || layout.as_base64) layouts.push_back(layout);
  }
  return layouts;
}

// The examples of RFC 4648.
TEST(Base64, PadsWhatIsNoTriple) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfb"), "//77");
}

TEST(Base64, WritesPiecesOfAnyLengthAsOneRun) {
  Random random(1);
  std::string bytes;
  for (int i = 0; i < 300000; ++i) bytes += static_cast<char>(random.below(256));
  for (const std::size_t most : {std::size_t{3}, std::size_t{1000}, std::size_t{200000}}) {
    const std::string written = hexpipe::testing::written_bytes([&](Output& output) {
      Base64Writer writer(output);
      for (std::size_t at = 0, count = 0; at < bytes.size(); at += count) {
        count = 1 + random.below(most);
        writer.write(std::string_view(bytes).substr(at, count));
      }
      writer.end();
    });
    EXPECT_TRUE(written == base64(bytes)) << most;
  }
}

TEST(Vtu, ReadsText) {
  const MixedMesh mesh = parsed(std::string(one_tet));
  EXPECT_EQ(mesh.points.size(), 5u);
  EXPECT_EQ(mesh.points[4], (Vec3{9, 9, 9}));
  EXPECT_THAT(mesh.tets.cells, ElementsAre(Tet{0, 1, 2, 3}));
  EXPECT_THAT(mesh.tets.tags, ElementsAre(7));
  EXPECT_THAT(mesh.triangles.cells, ElementsAre(Triangle{1, 2, 3}));
  EXPECT_THAT(mesh.triangles.tags, ElementsAre(-5));
}

TEST(Vtu, ReadsEveryLayout) {
  for (const Layout& layout : all_layouts())
    EXPECT_TRUE(parsed(LaidOut(layout).text()) == parsed(std::string(one_tet)))
        << layout.appended << layout.as_base64 << layout.long_header << layout.compressed << layout.big_endian;
}

TEST(Vtu, RejectsEveryTruncatedPrefix) {
  for (const Layout& layout : all_layouts()) {
    const std::string text = LaidOut(layout).text();
    for (std::size_t size = 0; size < text.size(); ++size)
      ASSERT_NE(message_of_reading(text.substr(0, size)), "") << size;
  }
  for (std::size_t size = 0; size + 1 < one_tet.size(); ++size)
    ASSERT_NE(message_of_reading(std::string(one_tet.substr(0, size))), "") << size;
}

TEST(Vtu, SurvivesDamagedData) {
  Random random(1);
  for (const Layout& layout : all_layouts()) {
    const std::string text = LaidOut(layout).text();
    for (int round = 0; round < 100; ++round) {
      std::string damaged = text;
      damaged[random.below(damaged.size())] = static_cast<char>(random.below(256));
      EXPECT_EQ(message_of_reading(damaged).find('\n'), std::string::npos);
    }
  }
}

std::string with_second_piece(std::string_view from, std::string_view to) {
  std::string text(one_tet);
  const std::size_t begin = text.find("<Piece"), end = text.find("</UnstructuredGrid>");
  std::string piece = text.substr(begin, end - begin);
  piece.replace(piece.find(from), from.size(), to);
  return text.insert(end, piece);
}

TEST(Vtu, JoinsPiecesAtEqualPoints) {
  // The second tet has the side (1, 2, 3) in common with the first one.
  const std::string text = with_second_piece("0 0 0 1 0 0 0 1 0", "1 1 1 1 0 0 0 1 0");
  std::vector<std::string> warnings;
  const MixedMesh mesh = read_vtu(text, "test", &warnings);
  EXPECT_EQ(mesh.points.size(), 6u);
  EXPECT_THAT(mesh.tets.cells, ElementsAre(Tet{0, 1, 2, 3}, Tet{5, 1, 2, 3}));
  EXPECT_THAT(warnings, ElementsAre("test: joined 2 pieces at 4 points with the coordinates of others"));
}

// As at a crack: in the second piece two points are in one place.
TEST(Vtu, LeavesPiecesApartWhereOneHasPointsInOnePlace) {
  const std::string text = with_second_piece("0 0 1 9 9 9", "0 0 1 0 0 1");
  std::vector<std::string> warnings;
  EXPECT_EQ(read_vtu(text, "test", &warnings).points.size(), 7u);
  EXPECT_THAT(warnings, ElementsAre("test: joined 2 pieces at 3 points with the coordinates of others",
                                    "test: in 1 places one piece has several points; its pieces are not joined there"));
  warnings.clear();
  std::string one_piece(one_tet);
  one_piece.replace(one_piece.find("9 9 9"), 5, "0 0 1");
  EXPECT_EQ(read_vtu(one_piece, "test", &warnings).points.size(), 5u);
  EXPECT_THAT(warnings, ElementsAre());
}

TEST(Vtu, JoinsPieces) {
  std::string text = with_second_piece("0 0 0 1 0 0 0 1 0\n          0 0 1 9 9 9", "5 0 0 6 0 0 5 1 0 5 0 1 5 9 9");
  const MixedMesh mesh = parsed(text);
  EXPECT_EQ(mesh.points.size(), 10u);
  EXPECT_THAT(mesh.tets.cells, ElementsAre(Tet{0, 1, 2, 3}, Tet{5, 6, 7, 8}));
  EXPECT_THAT(mesh.tets.tags, ElementsAre(7, 7));
  const std::size_t second = text.rfind("0 1 0 1 2 3");
  EXPECT_THAT(message_of_reading(text.replace(second, 11, "0 1 0 1 2 5")),
              HasSubstr("expected points from 0 to below 5, found 5"));
}

TEST(Vtu, RefusesPiecesThatShareTheirData) {
  std::string text = LaidOut({true, false, true, false, false}).text();
  const std::size_t begin = text.find("<Piece"), end = text.find("</UnstructuredGrid>");
  text.insert(end, text.substr(begin, end - begin));
  EXPECT_THAT(message_of_reading(text), HasSubstr("expected data of its own, found the data of other arrays"));
}

TEST(Vtu, NamesTheDefect) {
  const auto expect = [](std::string_view from, std::string_view to, const std::string& message) {
    EXPECT_EQ(message_of_reading(changed(from, to)), message);
  };
  expect("\"UnstructuredGrid\"", "\"ImageData\"",
         "test:3: expected VTKFile of type UnstructuredGrid or PolyData, found 'ImageData'");
  expect("byte_order", "header_type=\"UInt16\" byte_order",
         "test:3: expected header_type UInt32 or UInt64, found 'UInt16'");
  expect("byte_order", "compressor=\"vtkLZ4DataCompressor\" byte_order",
         "test:3: expected no compressor but vtkZLibDataCompressor, found 'vtkLZ4DataCompressor'");
  expect("</Cells>", "", "test:23: expected well-formed XML, found: Start-end tags mismatch");
  expect("NumberOfPoints=\"5\"", "NumberOfPoints=\"4\"", "test:14: expected 12 numbers only, found '9'");
  expect("NumberOfPoints=\"5\"", "NumberOfPoints=\"many\"",
         "test:5: expected a number as attribute NumberOfPoints, found 'many'");
  expect("NumberOfPoints=\"5\"", "NumberOfPoints=\"18446744073709551615\"",
         "test:5: expected a number of items, found 'a larger one'");
  expect("NumberOfPoints=\"5\"", "NumberOfPoints=\"1000000000\"",
         "test:12: array 'Points': expected 3000000000 numbers, found fewer");
  expect("NumberOfCells=\"3\"", "NumberOfCells=\"4\"", "test:21: array 'types': expected 4 numbers, found fewer");
  expect("9 9 9", "9 inf 9", "test:14: expected a number, found 'inf'");
  expect("9 9 9", "9 x 9", "test:14: expected a number, found 'x'");
  expect("1 7 -5", "1 7.5 -5", "test:8: expected a number, found '7.5'");
  expect("1 7 -5", "1 7", "test:8: array 'tag': expected 3 numbers, found fewer");
  expect("2 6 9", "2 6 -9", "test:18: expected offsets from 0 up, found -9");
  expect("2 6 9", "6 2 9", "test: cell 1: expected an offset of at least 6, found 2");
  expect("0 1 2 3 1", "0 1 2 5 1", "test:18: expected points from 0 to below 5, found 5");
  expect("3 10 5", "3 24 5", "test: cell 1: expected a linear cell of VTK type 5, 9, 10, 12, 13 or 14, found type 24");
  expect("\"offsets\"", "\"ends\"", "test:18: expected a DataArray named offsets, found none");
  expect("Name=\"offsets\" format=\"ascii\"", "Name=\"offsets\" format=\"hex\"",
         "test:20: array 'offsets': expected format ascii, binary or appended");
  expect("Name=\"offsets\" format=\"ascii\"", "Name=\"offsets\" format=\"appended\" offset=\"7\"",
         "test:20: array 'offsets': expected an offset up to 0, found 7");
  expect("Name=\"offsets\" format=\"ascii\">2 6 9", "Name=\"offsets\" format=\"binary\">AAAAAAA!",
         "test:20: array 'offsets': expected base64, found '!'");
  expect("Name=\"offsets\" format=\"ascii\">2 6 9", "Name=\"offsets\" format=\"binary\">/////w==",
         "test:20: array 'offsets': expected 4294967295 bytes, found at most 0");
  expect("\"UInt8\"", "\"String\"", "test:21: expected a type of numbers, found 'String'");
  expect("<Cells>", "<Verts/><Cells>", "");
  expect("<UnstructuredGrid>", "<UnstructuredGrid><Piece/>",
         "test:4: expected an attribute NumberOfPoints, found none");
}

TEST(Vtu, CountsLinesWithinTags) {
  const std::string three_lines = "<DataArray\n type=\"Int64\"\n Name=\"tag\" format=\"ascii\">";
  const std::string tag = "<DataArray type=\"Int64\" Name=\"tag\" format=\"ascii\">";
  EXPECT_EQ(message_of_reading(changed(tag + "1 7 -5", three_lines + "1 7 x")),
            "test:10: expected a number, found 'x'");
  std::string text = changed(tag, three_lines);
  text.replace(text.find("9 9 9"), 5, "9 x 9");
  EXPECT_EQ(message_of_reading(text), "test:16: expected a number, found 'x'");
  text = changed(tag, three_lines);
  text.replace(text.find("2 6 9"), 5, "2 6 -9");
  EXPECT_EQ(message_of_reading(text), "test:20: expected offsets from 0 up, found -9");
}

TEST(Vtu, NamesOfPiecesAreEscaped) {
  const std::string text = hexpipe::testing::written_bytes([](Output& output) {
    write_pvtu({"R&D/part-0000.vtu", "a<b>\"c\"/part-0001.vtu"}, output);
  });
  EXPECT_THAT(text, HasSubstr("<Piece Source=\"R&amp;D/part-0000.vtu\"/>"));
  EXPECT_THAT(text, HasSubstr("<Piece Source=\"a&lt;b&gt;&quot;c&quot;/part-0001.vtu\"/>"));
}

TEST(Vtu, RefusesImpossibleCompression) {
  std::string text = LaidOut({true, false, true, true, false}).text();
  // The size of a block in the first array's header, behind the number of blocks.
  text[text.find(" _") + 2 + 8 + 5] = '\x01';
  EXPECT_THAT(message_of_reading(text), HasSubstr("which is impossible"));
}

}  // namespace
}  // namespace hexpipe
