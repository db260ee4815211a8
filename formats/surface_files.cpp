#include "formats/surface_files.hpp"

#include <limits>

#include "common/run/error.hpp"
#include "formats/obj.hpp"
#include "formats/off.hpp"
#include "formats/ply.hpp"
#include "formats/stl.hpp"
#include "formats/surface_building.hpp"

namespace hexpipe {
namespace {

// An ASCII STL begins like some binary ones: "solid". The high byte of a binary header's count is zero in any file
// below 800 MB, a text has no zero byte.
bool has_zero_byte_in_header(std::string_view bytes) {
  return bytes.substr(0, 84).find('\0') != std::string_view::npos;
}

bool is_archive(std::string_view bytes) {
  return bytes.starts_with("\x28\xb5\x2f\xfd") || (bytes.size() > 262 && bytes.substr(257, 5) == "ustar");
}

SurfaceSoup read_by_content(std::string_view bytes, const std::string& name) {
  if (bytes.empty())
    throw DataError::at(name, "expected a surface in STL, OBJ, PLY or OFF, found nothing: it is empty");
  if (is_archive(bytes))
    throw DataError::at(name, "expected a surface in STL, OBJ, PLY or OFF, found a bundle or another archive");
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return merge_equal_points(read_ply(bytes, name));
  if (is_binary_stl(bytes)) return read_binary_stl(bytes, name);
  const std::string_view first = TextScanner(bytes, name, '#').peek_word();
  if (is_off_keyword(first)) return merge_equal_points(read_off(bytes, name));
  if (equal_ignoring_case(first, "solid") && !has_zero_byte_in_header(bytes)) return read_ascii_stl(bytes, name);
  if (is_obj_keyword(first) || first.empty()) return merge_equal_points(read_obj(bytes, name));
  if (has_zero_byte_in_header(bytes)) return read_binary_stl(bytes, name);
  throw DataError::at(name, "expected a surface in STL, OBJ, PLY or OFF, found {}", quote_found(first));
}

}  // namespace

std::string SurfaceSoup::place_of(std::size_t triangle) const {
  return text ? fmt::format("{}:{}", name, places[triangle]) : fmt::format("{}: triangle {}", name, places[triangle]);
}

SurfaceSoup read_surface(Input& input) {
  SurfaceSoup soup = read_by_content(input.read_all(), input.name());
  soup.name = input.name();
  if (soup.triangles.empty()) throw DataError::at(soup.name, "expected a surface, found no triangles");
  if (soup.triangles.size() > std::numeric_limits<std::int32_t>::max() / 3)
    throw DataError::at(soup.name, "expected fewer than 2^31 / 3 triangles, found {}", soup.triangles.size());
  return soup;
}

}  // namespace hexpipe
