#include "formats/points/point_files.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "common/run/error.hpp"
#include "formats/pipeline/npy.hpp"
#include "formats/streams/scalar_bytes.hpp"
#include "formats/streams/text_scanner.hpp"
#include "formats/surfaces/ply.hpp"
#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

PointList read_npy_points(std::string_view bytes, const std::string& name) {
  const std::size_t header_size = pipeline::npy_header_size(bytes.substr(0, 10));
  if (header_size > bytes.size())
    throw DataError::at(name, "expected {} bytes of header, found {}", header_size, bytes.size());
  const pipeline::NpyHeader header = pipeline::parse_npy_header(bytes.substr(0, header_size), name);
  if (header.shape.size() != 2 || header.shape[1] != 3 || header.type.kind != 'f' || header.type.bytes < 4)
    throw DataError::at(name, "expected an array of floats with three columns, found another shape or type");
  const std::string_view body = bytes.substr(header_size);
  const auto row_bytes = 3 * static_cast<std::uint64_t>(header.type.bytes);
  if (body.size() % row_bytes != 0 || body.size() / row_bytes != header.shape[0])
    throw DataError::at(name, "expected {} points of {} bytes, found {} bytes", header.shape[0], row_bytes,
                        body.size());
  const auto type = header.type.bytes == 4 ? ScalarType::float32 : ScalarType::float64;
  const std::vector<double> numbers = convert_scalars<double>(body, type, std::endian::little, name);
  PointList list;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    list.points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return list;
}

// "n 3 a m" followed by a line that begins with 0 or 1 can hardly be two points.
bool looks_like_node(std::string_view text, const std::string& name) {
  TextScanner scanner(text, name, '#');
  std::string_view words[4];
  for (std::string_view& word : words) {
    if (scanner.at_end() || (&word != words && scanner.at_line_end())) return false;
    word = scanner.word("a number");
    if (word.find_first_not_of("0123456789") != std::string_view::npos) return false;
  }
  if (words[1] != "3" || !scanner.at_line_end()) return false;
  const std::string_view first = scanner.peek_word();
  return first == "0" || first == "1" || words[0] == "0";
}

PointList read_node_points(std::string_view text, const std::string& name) {
  TextScanner scanner(text, name, '#');
  PointList list;
  const std::size_t count = scanner.count("the number of points", 8);
  scanner.rest_of_line();
  for (std::size_t i = 0; i < count; ++i) {
    scanner.number<std::int64_t>("the number of a point");
    list.lines.push_back(scanner.line());
    list.points.push_back(read_coordinates(scanner));
    scanner.rest_of_line();
  }
  if (!scanner.at_end()) scanner.fail_expected("nothing after the points", scanner.peek_word());
  return list;
}

PointList read_xyz_points(std::string_view text, const std::string& name) {
  TextScanner scanner(text, name, '#');
  PointList list;
  while (!scanner.at_end()) {
    list.lines.push_back(scanner.line());
    list.points.push_back(read_coordinates(scanner));
    scanner.rest_of_line();
  }
  return list;
}

PointList read_points_by_content(std::string_view bytes, const std::string& name) {
  if (pipeline::npy_header_size(bytes.substr(0, 10)) > 0) return read_npy_points(bytes, name);
  bytes = without_byte_order_mark(bytes);
  if (looks_like_ply(bytes)) return {read_ply(bytes, name).points, {}, {}};
  if (!bytes.empty()) expect_last_line_end(bytes, name);
  if (looks_like_node(bytes, name)) return read_node_points(bytes, name);
  return read_xyz_points(bytes, name);
}

}  // namespace

std::string PointList::place_of(std::size_t point) const {
  return lines.empty() ? fmt::format("{}: point {}", name, point + 1) : fmt::format("{}:{}", name, lines[point]);
}

PointList read_points(Input& input) {
  PointList list = read_points_by_content(input.read_all(), input.name());
  list.name = input.name();
  for (std::size_t i = 0; i < list.points.size(); ++i)
    if (!is_place(list.points[i]))
      throw DataError::at(list.place_of(i), "expected coordinates up to {}, found others", largest_coordinate);
  return list;
}

}  // namespace hexpipe::formats
