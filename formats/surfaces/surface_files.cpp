#include "formats/surfaces/surface_files.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "common/run/error.hpp"
#include "formats/surfaces/obj.hpp"
#include "formats/surfaces/off.hpp"
#include "formats/surfaces/ply.hpp"
#include "formats/surfaces/stl.hpp"
#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

// An ASCII STL begins like some binary ones: "solid". The high byte of a binary header's count is zero in any file
// below 800 MB, a text has no zero byte.
bool has_zero_byte_in_header(std::string_view bytes) {
  return bytes.substr(0, 84).find('\0') != std::string_view::npos;
}

bool is_archive(std::string_view bytes) {
  return bytes.starts_with("\x28\xb5\x2f\xfd") || (bytes.size() > 262 && bytes.substr(257, 5) == "ustar");
}

// CAD files by their first bytes: triangles have to be made of them first.
std::optional<std::string_view> hint_for_cad(std::string_view bytes) {
  if (bytes.starts_with("ISO-10303-21")) return "CAD in STEP";
  if (bytes.starts_with("DBRep_DrawableShape") || bytes.starts_with("CASCADE Topology")) return "CAD in BREP";
  if (bytes.size() > 80 && bytes.substr(0, 81).find('\n') == std::string_view::npos && bytes[72] == 'S' &&
      bytes.substr(73, 7) == "      1")
    return "CAD in IGES";
  return std::nullopt;
}

SurfaceSoup read_surface_by_content(std::string_view bytes, const std::string& name) {
  if (bytes.empty())
    throw DataError::at(name, "expected a surface in STL, OBJ, PLY or OFF, found nothing: it is empty");
  if (is_archive(bytes))
    throw DataError::at(name, "expected a surface in STL, OBJ, PLY or OFF, found a bundle or another archive");
  if (const auto hint = hint_for_cad(bytes))
    throw DataError::at(name,
                        "expected a surface in STL, OBJ, PLY or OFF, found {}; 'tessellate {} | tetmesh' meshes it",
                        *hint, name == "stdin" ? "FILE" : name);
  if (is_binary_stl(bytes)) return read_binary_stl(bytes, name);
  bytes = without_byte_order_mark(bytes);
  if (looks_like_ply(bytes)) return merge_equal_points(read_ply(bytes, name));
  const std::string_view first = TextScanner(bytes, name, '#').peek_word();
  if (is_off_keyword(first)) return merge_equal_points(read_off(bytes, name));
  if (equal_ignoring_case(first, "solid") && !has_zero_byte_in_header(bytes)) return read_ascii_stl(bytes, name);
  if (is_obj_keyword(first) || first.empty()) return merge_equal_points(read_obj(bytes, name));
  if (has_zero_byte_in_header(bytes)) return read_binary_stl(bytes, name);
  throw DataError::at(name, "expected a surface in STL, OBJ, PLY or OFF, found {}", quote_found(first));
}

// The counterpart of largest_coordinate: volumes and squares of determinants of shorter extents vanish.
constexpr double least_extent = 1e-50;

void check_magnitude(const SurfaceSoup& soup) {
  double least = std::numeric_limits<double>::max(), greatest = std::numeric_limits<double>::lowest(), extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto along_axis = [&](const Vec3& p) { return p[axis]; };
    const auto [lowest, highest] = std::ranges::minmax_element(soup.points, {}, along_axis);
    const double low = along_axis(*lowest), high = along_axis(*highest);
    least = std::min(least, low);
    greatest = std::max(greatest, high);
    extent = std::max(extent, high - low);
  }
  if (std::max(-least, greatest) > largest_coordinate)
    throw DataError::at(soup.name, "expected coordinates up to {:g}, found {:g}; scale the surface", largest_coordinate,
                        -least > greatest ? least : greatest);
  if (extent < least_extent)
    throw DataError::at(soup.name, "expected a surface at least {:g} long, found one of {:g}; scale the surface",
                        least_extent, extent);
}

}  // namespace

std::string SurfaceSoup::place_of(std::size_t triangle) const {
  return text ? fmt::format("{}:{}", name, places[triangle]) : fmt::format("{}: triangle {}", name, places[triangle]);
}

SurfaceSoup read_surface(Input& input) {
  SurfaceSoup soup = read_surface_by_content(input.read_all(), input.name());
  soup.name = input.name();
  check_extent(soup);
  return soup;
}

void check_extent(const SurfaceSoup& soup) {
  if (soup.triangles.empty()) throw DataError::at(soup.name, "expected a surface, found no triangles");
  if (soup.triangles.size() > std::numeric_limits<std::int32_t>::max() / 3)
    throw DataError::at(soup.name, "expected fewer than 2^31 / 3 triangles, found {}", soup.triangles.size());
  check_magnitude(soup);
}

}  // namespace hexpipe::formats
