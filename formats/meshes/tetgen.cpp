#include "formats/meshes/tetgen.hpp"

#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include "formats/meshes/facet_table.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/scalar_bytes.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

// Comments and empty lines may stand anywhere. Nothing marks the end of a file, so only the end of its last line tells
// a last number from the beginning of one.
TextScanner scanner_of(std::string_view text, std::string_view file) {
  expect_last_line_end(text, file);
  return {text, file, '#'};
}

// The numbers of the first line that has any.
struct Head {
  std::size_t items = 0;
  std::int64_t numbers[3] = {0, 0, 0};  // 0 where the line has fewer
};

Head read_head(TextScanner& scanner, std::string_view what, std::size_t bytes_each) {
  Head head{scanner.count(what, bytes_each)};
  for (std::int64_t& number : head.numbers)
    if (!scanner.at_line_end()) number = scanner.number<std::int64_t>("a number of the first line");
  return head;
}

// A number that must stand on the line where the scanner is.
template <class T>
T number_in_line(TextScanner& scanner, std::string_view what) {
  if (scanner.at_line_end()) scanner.fail(fmt::format("expected {}, found the end of the line", what));
  return scanner.number<T>(what);
}

void check_end(TextScanner& scanner, std::string_view items) {
  if (!scanner.at_end()) scanner.fail_expected(fmt::format("nothing after the {}", items), scanner.peek_word());
}

class TetgenReader {
 public:
  void read_nodes(std::string_view text, std::string_view file) {
    TextScanner scanner = scanner_of(text, file);
    const Head head = read_head(scanner, "the number of points", 8);
    if (head.numbers[0] != 3) scanner.fail_expected("dimension 3", std::to_string(head.numbers[0]));
    if (head.items > static_cast<std::size_t>(std::numeric_limits<Vertex>::max()))
      scanner.fail_expected("fewer than 2^31 points", std::to_string(head.items));
    mesh_.points.reserve(head.items);
    for (std::size_t i = 0; i < head.items; ++i) {
      const auto number = scanner.number<std::int64_t>("the number of a point");
      if (i == 0 && (number == 0 || number == 1)) first_ = number;
      const auto expected = first_ + static_cast<std::int64_t>(i);
      if (number != expected) scanner.fail_expected(fmt::format("point {}", expected), std::to_string(number));
      const auto x = number_in_line<double>(scanner, "a coordinate");
      const auto y = number_in_line<double>(scanner, "a coordinate");
      const auto z = number_in_line<double>(scanner, "a coordinate");
      mesh_.points.push_back({x, y, z});
      scanner.rest_of_line();
    }
    check_end(scanner, "points");
    range_ = fmt::format("a point from {} to {}", first_, first_ + static_cast<std::int64_t>(head.items) - 1);
  }

  void read_tets(std::string_view text, std::string_view file) {
    TextScanner scanner = scanner_of(text, file);
    const Head head = read_head(scanner, "the number of tets", 10);
    if (head.numbers[0] != 4) scanner.fail_expected("4 corners a tet (first order)", std::to_string(head.numbers[0]));
    const bool has_region = head.numbers[1] > 0;
    read_lines(scanner, head.items, mesh_.tets, [&] { return has_region ? region(scanner) : 0; });
    check_end(scanner, "tets");
  }

  void read_faces(std::string_view text, std::string_view file) {
    TextScanner scanner = scanner_of(text, file);
    const Head head = read_head(scanner, "the number of faces", 8);
    const bool has_marker = head.numbers[0] > 0;
    read_lines(scanner, head.items, mesh_.triangles,
               [&] { return has_marker ? number_in_line<std::int32_t>(scanner, "the marker of a face") : 0; });
    check_end(scanner, "faces");
    drop_inner_faces();
  }

  MixedMesh take_mesh() { return std::move(mesh_); }

 private:
  // Each line has a number, the corners, what `tag` reads, and maybe more, which is skipped.
  template <int Corners, class ReadTag>
  void read_lines(TextScanner& scanner, std::size_t count, CellBlock<Corners>& block, ReadTag&& tag) {
    block.cells.reserve(count);
    block.tags.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      scanner.number<std::int64_t>("the number of a line");
      for (Vertex& corner : block.cells.emplace_back()) corner = read_corner(scanner);
      block.tags.push_back(tag());
      scanner.rest_of_line();
    }
  }

  Vertex read_corner(TextScanner& scanner) const {
    const auto number = number_in_line<std::int64_t>(scanner, range_);
    if (number < first_ || number >= first_ + static_cast<std::int64_t>(mesh_.points.size()))
      scanner.fail_expected(range_, std::to_string(number));
    return static_cast<Vertex>(number - first_);
  }

  // When asked for all faces, TetGen also lists those inside a region, with marker 0: they are no surface.
  void drop_inner_faces() {
    const std::vector<char> inside = faces_inside_regions();
    CellBlock<3> kept;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      if (inside[i] != 0 && mesh_.triangles.tags[i] == 0) continue;
      kept.cells.push_back(mesh_.triangles.cells[i]);
      kept.tags.push_back(mesh_.triangles.tags[i]);
    }
    mesh_.triangles = std::move(kept);
  }

  // Faces that two tets of one region share. Tets may be listed in any sense, so the vertices alone say which.
  std::vector<char> faces_inside_regions() const {
    const FacetTable<3> faces(mesh_.triangles.cells, mesh_.points.size());
    std::vector<char> inside(mesh_.triangles.size(), 0);
    std::vector<std::int64_t> first_tet(mesh_.triangles.size(), no_index);
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
      for (const LocalTriangle& corners : TetTopology::triangles)
        faces.visit_same(pick(mesh_.tets.cells[t], corners), [&](std::size_t face) {
          const auto tet = static_cast<std::int64_t>(t);
          std::int64_t& first = first_tet[face];
          if (first == no_index) first = tet;
          if (first != tet)
            inside[face] = mesh_.tets.tags[t] == mesh_.tets.tags[static_cast<std::size_t>(first)] ? 1 : 0;
        });
    return inside;
  }

  // Attributes are real numbers; a region's is a whole one.
  static std::int32_t region(TextScanner& scanner) {
    const auto attribute = number_in_line<double>(scanner, "the region of a tet");
    if (!converts_exactly<std::int32_t>(attribute))
      scanner.fail_expected("the region of a tet as a whole number", fmt::format("{}", attribute));
    return static_cast<std::int32_t>(attribute);
  }

  MixedMesh mesh_;
  std::int64_t first_ = 0;  // points are numbered from 0 or 1
  std::string range_;
};

// A .node file begins with number, dimension, attributes, markers; an .ele file with number, corners, attributes.
bool is_tet_file(std::string_view text, std::string_view file) {
  TextScanner scanner(text, file, '#');
  const Head head = read_head(scanner, "the number of points or tets", 1);
  if (head.numbers[0] != 3 && head.numbers[0] != 4 && head.numbers[0] != 10)
    scanner.fail(fmt::format("expected a mesh; as TetGen's .node or .ele, 3 or 4 after {}, found {}", head.items,
                             head.numbers[0]));
  return head.numbers[0] != 3;
}

// part.node has part.ele beside it, part.node.gz has part.ele.gz.
std::string path_beside(std::filesystem::path path, const char* extension) {
  const std::filesystem::path packing = path.extension() == ".gz" ? path.extension() : "";
  if (!packing.empty()) path.replace_extension();
  path.replace_extension(extension);
  path += packing;
  return path.string();
}

std::string read_beside(const std::string& path, const char* extension, std::string& name) {
  name = path_beside(path, extension);
  return Input::open(name).read_all();
}

}  // namespace

bool looks_like_tetgen(std::string_view text) {
  const std::string_view word = TextScanner(text, "", '#').peek_word();
  return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
}

MixedMesh read_tetgen(std::string_view text, const std::string& name, const std::string& path) {
  if (path.empty())
    throw DataError::at(name, "expected the path of a TetGen .node or .ele file, to find the other beside it");
  TetgenReader reader;
  const bool is_tets = is_tet_file(text, name);
  std::string other_name;
  const std::string other = read_beside(path, is_tets ? ".node" : ".ele", other_name);
  reader.read_nodes(is_tets ? other : text, is_tets ? other_name : name);
  reader.read_tets(is_tets ? text : other, is_tets ? name : other_name);
  if (std::filesystem::exists(path_beside(path, ".face"))) {
    std::string face_name;
    const std::string faces = read_beside(path, ".face", face_name);
    reader.read_faces(faces, face_name);
  }
  return reader.take_mesh();
}

}  // namespace hexpipe::formats
