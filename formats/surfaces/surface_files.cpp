#include "formats/surfaces/surface_files.hpp"

#include <optional>

#include "common/run/error.hpp"
#include "formats/streams/foreign_files.hpp"
#include "formats/surfaces/obj.hpp"
#include "formats/surfaces/off.hpp"
#include "formats/surfaces/ply.hpp"
#include "formats/surfaces/stl.hpp"
#include "formats/surfaces/surface_building.hpp"
#include "formats/surfaces/threemf.hpp"

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

constexpr std::string_view expected = "expected a surface in STL, OBJ, PLY, OFF or 3MF";

[[noreturn]] void refuse(const ForeignFile& kind, const std::string& name) {
  if (!kind.is_cad) throw DataError::at(name, "{}, found {}{}", expected, kind.name, kind.remedy);
  throw DataError::at(name, "{}, found {}; 'tessellate {} | tetmesh' meshes it", expected, kind.name,
                      name == "stdin" ? "FILE" : name);
}

SurfaceSoup read_surface_by_content(std::string& content, const std::string& name) {
  if (content.empty()) throw DataError::at(name, "{}, found nothing: it is empty", expected);
  if (is_archive(content)) throw DataError::at(name, "{}, found a bundle or another archive", expected);
  if (looks_like_3mf(content)) return merge_equal_points(read_3mf(content, name));
  if (is_binary_stl(content)) return read_binary_stl(content, name);
  if (const auto kind = kind_of_foreign_file(without_byte_order_mark(content))) refuse(*kind, name);
  unify_line_ends(content);
  const std::string_view bytes = without_byte_order_mark(content);
  if (looks_like_ply(bytes)) return merge_equal_points(read_ply(bytes, name));
  const std::string_view first = TextScanner(bytes, name, '#').peek_word();
  if (is_off_keyword(first)) return merge_equal_points(read_off(bytes, name));
  if (may_be_binary_stl(content)) return read_binary_stl(content, name);
  const bool is_text = !has_zero_byte_in_header(bytes);
  if (equal_ignoring_case(first, "solid") && is_text) return read_ascii_stl(bytes, name);
  if (is_obj_keyword(first) || (first.empty() && is_text)) return merge_equal_points(read_obj(bytes, name));
  if (is_cut_binary_stl(content)) return read_binary_stl(content, name);
  if (!is_text) throw DataError::at(name, "{}, found a binary file of another kind", expected);
  throw DataError::at(name, "{}, found {}", expected, quote_found(first));
}

}  // namespace

SurfaceSoup read_surface(Input& input) {
  std::string content = input.read_all();
  SurfaceSoup soup = read_surface_by_content(content, input.name());
  soup.name = input.name();
  check_extent(soup);
  return soup;
}

}  // namespace hexpipe::formats
