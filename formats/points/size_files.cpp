#include "formats/points/size_files.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "common/run/error.hpp"
#include "formats/meshes/msh.hpp"
#include "formats/pipeline/npy.hpp"
#include "formats/streams/scalar_bytes.hpp"
#include "formats/streams/text_scanner.hpp"
#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

bool is_size(double size) {
  return std::isfinite(size) && size > 0;
}

void add(SizeList& list, const Vec3& point, double size) {
  const auto number = static_cast<Vertex>(list.points.size());
  list.points.push_back(point);
  list.sizes.push_back(size);
  list.simplices.push_back({number, no_index, no_index, no_index});
}

// A line is a size, or a place and its size; the first line tells which.
SizeList read_text(std::string_view text, const std::string& name) {
  TextScanner scanner(text, name, '#');
  SizeList list;
  std::optional<bool> has_places;
  while (!scanner.at_end()) {
    const auto first = scanner.number<double>("a size, or a place and its size");
    if (!has_places) has_places = !scanner.at_line_end();
    Vec3 place{first, 0, 0};
    double size = first;
    if (*has_places) {
      place.y = number_on_line<double>(scanner, "a coordinate");
      place.z = number_on_line<double>(scanner, "a coordinate");
      size = number_on_line<double>(scanner, "a size");
    }
    if (!scanner.at_line_end()) scanner.fail_expected("the end of the line", scanner.peek_word());
    if (*has_places && !is_place(place))
      scanner.fail(
          fmt::format("expected coordinates up to {}, found {} {} {}", largest_coordinate, place.x, place.y, place.z));
    if (!is_size(size)) scanner.fail(fmt::format("expected a positive size, found {:g}", size));
    if (*has_places)
      add(list, place, size);
    else
      list.sizes.push_back(size);
  }
  return list;
}

SizeList read_npy(std::string_view bytes, const std::string& name) {
  const std::size_t header_size = pipeline::npy_header_size(bytes.substr(0, 10));
  if (header_size > bytes.size())
    throw DataError::at(name, "expected {} bytes of header, found {}", header_size, bytes.size());
  const pipeline::NpyHeader header = pipeline::parse_npy_header(bytes.substr(0, header_size), name);
  const bool has_places = header.shape.size() == 2 && header.shape[1] == 4;
  if (!(header.shape.size() == 1 || has_places) || header.type.kind != 'f' || header.type.bytes < 4)
    throw DataError::at(name, "expected an array of floats, of one dimension or with four columns, found another one");
  const std::size_t columns = has_places ? 4 : 1;
  const std::string_view body = bytes.substr(header_size);
  const auto row_bytes = columns * static_cast<std::uint64_t>(header.type.bytes);
  if (body.size() % row_bytes != 0 || body.size() / row_bytes != header.shape[0])
    throw DataError::at(name, "expected {} rows of {} bytes, found {} bytes", header.shape[0], row_bytes, body.size());
  const auto type = header.type.bytes == 4 ? ScalarType::float32 : ScalarType::float64;
  const std::vector<double> numbers = convert_scalars<double>(body, type, std::endian::little, name);
  SizeList list;
  for (std::size_t i = 0; i < numbers.size(); i += columns) {
    const Vec3 place = has_places ? Vec3{numbers[i], numbers[i + 1], numbers[i + 2]} : Vec3{};
    const double size = numbers[i + columns - 1];
    if (!is_size(size) || !is_place(place))
      throw DataError::at(name, "row {}: expected coordinates up to {} and a positive size, found others",
                          i / columns + 1, largest_coordinate);
    if (has_places)
      add(list, place, size);
    else
      list.sizes.push_back(size);
  }
  return list;
}

// Leaves out nodes that no simplex uses; they need no size.
void keep_used_nodes(SizeList& list) {
  std::vector<Vertex> number(list.points.size(), no_index);
  Vertex count = 0;
  for (auto& simplex : list.simplices)
    for (Vertex& v : simplex) {
      if (v == no_index) continue;
      if (number[v] == no_index) number[v] = count++;
      v = number[v];
    }
  SizeList used{std::vector<double>(count), std::vector<Vec3>(count), std::move(list.simplices), {}};
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == no_index) continue;
    used.points[number[v]] = list.points[v];
    used.sizes[number[v]] = list.sizes[v];
  }
  list = std::move(used);
}

SizeList read_background(std::string_view text, const std::string& name) {
  MshNodeValues field = read_msh_node_values(text, name);
  const MixedMesh& mesh = field.mesh;
  validate(mesh, name.c_str());
  if (!mesh.hexes.cells.empty() || !mesh.prisms.cells.empty() || !mesh.pyramids.cells.empty())
    throw DataError::at(name, "expected a background mesh of tets or triangles, found other cells");
  SizeList list{std::move(field.values), mesh.points, {}, {}};
  for (const Tet& tet : mesh.tets.cells) list.simplices.push_back(tet);
  if (list.simplices.empty())
    for (const auto& [a, b, c] : mesh.triangles.cells) list.simplices.push_back({a, b, c, no_index});
  if (list.simplices.empty()) throw DataError::at(name, "expected a background mesh of tets or triangles, found none");
  for (const auto& simplex : list.simplices)
    for (const Vertex v : simplex)
      if (v != no_index && !is_size(list.sizes[v]))
        throw DataError::at(name,
                            "expected a positive size at every node of $NodeData, found {:g} at ({:g}, {:g}, {:g})",
                            list.sizes[v], list.points[v].x, list.points[v].y, list.points[v].z);
  keep_used_nodes(list);
  return list;
}

SizeList read_sizes_by_content(std::string_view bytes, const std::string& name) {
  if (pipeline::npy_header_size(bytes.substr(0, 10)) > 0) return read_npy(bytes, name);
  bytes = without_byte_order_mark(bytes);
  if (looks_like_msh(bytes)) return read_background(bytes, name);
  if (!bytes.empty()) expect_last_line_end(bytes, name);
  return read_text(bytes, name);
}

}  // namespace

SizeList read_sizes(Input& input) {
  SizeList list = read_sizes_by_content(input.read_all(), input.name());
  if (list.sizes.empty()) throw DataError::at(input.name(), "expected sizes, found none");
  list.name = input.name();
  return list;
}

SizeList on_surface(SizeList sizes, const SurfaceSoup& surface) {
  if (!sizes.points.empty()) return sizes;
  if (surface.file_vertices.empty())
    throw DataError::at(sizes.name,
                        "expected sizes with their places (x y z size), for {} has no vertices with an order, found "
                        "sizes alone",
                        surface.name);
  if (surface.file_vertex_count != sizes.sizes.size())
    throw DataError::at(sizes.name, "expected {} sizes, one for each vertex of {}, found {}", surface.file_vertex_count,
                        surface.name, sizes.sizes.size());
  SizeList list{{}, surface.points, {}, sizes.name};
  for (const Vertex v : surface.file_vertices) list.sizes.push_back(sizes.sizes[v]);
  for (const auto& [a, b, c] : surface.triangles) list.simplices.push_back({a, b, c, no_index});
  return list;
}

}  // namespace hexpipe::formats
