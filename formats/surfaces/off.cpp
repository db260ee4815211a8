#include "formats/surfaces/off.hpp"

#include <vector>

#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

// The prefixes of the keyword in the order in which they may come.
std::string_view without_optional_prefixes(std::string_view word) {
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"})
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  return word;
}

// The number of vertices may follow without a blank, as in many files of ModelNet: OFF8.
std::string_view without_digits_behind(std::string_view word) {
  return word.substr(0, word.find_last_not_of("0123456789") + 1);
}

void read_off_header(TextScanner& scanner) {
  const std::string_view word = scanner.peek_word();
  if (!is_off_keyword(word)) scanner.fail_expected("OFF", word);
  const std::string_view keyword = scanner.raw(without_digits_behind(word).size(), "OFF");
  if (keyword.find_first_of("4n") != std::string_view::npos) scanner.fail_expected("OFF in three dimensions", keyword);
  if (equal_ignoring_case(scanner.peek_word(), "BINARY")) scanner.fail_expected("ASCII OFF", "BINARY");
}

void read_face(TextScanner& scanner, std::vector<Vertex>& corners, PolygonReader& polygons, SurfaceSoup& soup) {
  const std::size_t vertex_count = soup.points.size();
  const std::size_t corner_count = scanner.count("the number of a face's vertices", 2);
  const long line = scanner.line();
  if (corner_count < 3) scanner.fail(fmt::format("expected a face of three or more vertices, found {}", corner_count));
  corners.clear();
  for (std::size_t i = 0; i < corner_count; ++i) {
    const auto index = scanner.number<std::int64_t>("a vertex index");
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count)
      scanner.fail_expected(fmt::format("a vertex index below {}", vertex_count), std::to_string(index));
    corners.push_back(static_cast<Vertex>(index));
  }
  scanner.rest_of_line();  // colour
  polygons.append(soup, corners, 0, line);
}

}  // namespace

bool is_off_keyword(std::string_view word) {
  return without_optional_prefixes(without_digits_behind(word)) == "OFF";
}

SurfaceSoup read_off(std::string_view text, const std::string& name) {
  TextScanner scanner(text, name, '#');
  read_off_header(scanner);
  // The shortest vertex is "0 0 0" with its line end, the shortest face "3 0 0 0".
  const std::size_t vertex_count = scanner.count("the number of vertices", 6);
  check_point_count(vertex_count, name);
  const std::size_t face_count = scanner.count("the number of faces", 7);
  scanner.rest_of_line();  // number of edges

  SurfaceSoup soup;
  soup.points.reserve(vertex_count);
  for (std::size_t i = 0; i < vertex_count; ++i) {
    scanner.peek_word();  // goes to the vertex's line
    soup.points.push_back(read_coordinates(scanner));
    scanner.rest_of_line();  // normal, colour, texture coordinates
  }
  soup.triangles.reserve(face_count);
  std::vector<Vertex> corners;
  PolygonReader polygons;
  for (std::size_t i = 0; i < face_count; ++i) read_face(scanner, corners, polygons, soup);
  if (!scanner.at_end())
    scanner.fail_expected(fmt::format("the end of the file after {} faces", face_count), scanner.peek_word());
  polygons.cut_concave(soup);
  return soup;
}

}  // namespace hexpipe::formats
