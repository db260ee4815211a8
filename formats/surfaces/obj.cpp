#include "formats/surfaces/obj.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

// The statements of polygonal OBJ. The first statement of a free-form curve or surface is an error.
constexpr std::array<std::string_view, 19> keywords{
    "v",  "vt",  "vn",       "vp",       "f",      "g",      "o",      "s",      "l",    "p",
    "mg", "lod", "c_interp", "d_interp", "usemtl", "mtllib", "usemap", "maplib", "bevel"};

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& name) : name_(name), text_(text), scanner_(text, name, '#') {}

  SurfaceSoup read();

 private:
  void read_statement(std::string_view keyword);
  void skip_statement();
  std::string read_group_name();
  void read_face();
  Vertex vertex_index(std::string_view word) const;
  void set_tags();
  void check_corners() const;

  const std::string& name_;
  std::string_view text_;
  TextScanner scanner_;
  SurfaceSoup soup_;
  std::vector<Vertex> corners_;
  PolygonReader polygons_;
  // Numbers the names that have faces, in the order in which they come.
  class Names {
   public:
    void begin(std::string name) {
      name_ = std::move(name);
      tag_.reset();
    }
    std::int32_t tag() {
      if (!name_) return 0;
      if (!tag_) tag_ = known_.try_emplace(*name_, known_.size() + 1).first->second;
      return *tag_;
    }
    const std::map<std::string, std::int32_t>& known() const { return known_; }

   private:
    std::optional<std::string> name_;
    std::optional<std::int32_t> tag_;  // once the name has a face
    std::map<std::string, std::int32_t> known_;
  };
  Names groups_, materials_;
  std::vector<std::int32_t> material_tags_;  // of triangles
};

SurfaceSoup ObjReader::read() {
  while (!scanner_.at_end()) read_statement(scanner_.word("an OBJ statement"));
  check_corners();
  polygons_.cut_concave(soup_);
  set_tags();
  return std::move(soup_);
}

// Materials distinguish faces that are in no group.
void ObjReader::set_tags() {
  const bool by_material = groups_.known().empty() && !materials_.known().empty();
  if (by_material) soup_.tags = std::move(material_tags_);
  for (const auto& [name, tag] : (by_material ? materials_ : groups_).known())
    if (std::string text = clean_name(name); !text.empty()) soup_.names.surfaces[tag] = std::move(text);
}

void ObjReader::read_statement(std::string_view keyword) {
  if (keyword == "v") {
    soup_.points.push_back(read_coordinates(scanner_));
    skip_statement();  // weight or colour
  } else if (keyword == "f") {
    read_face();
  } else if (keyword == "g" || keyword == "o") {
    groups_.begin(read_group_name());
  } else if (keyword == "usemtl") {
    materials_.begin(read_group_name());
  } else if (is_obj_keyword(keyword)) {
    skip_statement();
  } else {
    scanner_.fail_expected("an OBJ statement", keyword);
  }
}

// A backslash at the end of a line carries the statement on.
void ObjReader::skip_statement() {
  while (scanner_.rest_of_line().ends_with('\\') && !scanner_.at_end()) {
  }
}

// Blanks around a name do not count. Within a word, '#' is part of the name: Face#12.
std::string ObjReader::read_group_name() {
  constexpr std::string_view blanks = " \t\r";
  std::string_view line = text_.substr(scanner_.position());
  line = line.substr(0, line.find('\n'));
  scanner_.rest_of_line();
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1))
    if (at == 0 || blanks.find(line[at - 1]) != std::string_view::npos) line = line.substr(0, at);
  const std::size_t first = std::min(line.find_first_not_of(blanks), line.size());
  return std::string(line.substr(first, line.find_last_not_of(blanks) + 1 - first));
}

void ObjReader::read_face() {
  const long line = scanner_.line();
  corners_.clear();
  bool carried_on = false;
  while (carried_on || !scanner_.at_line_end()) {
    std::string_view word = scanner_.word("a vertex index");
    carried_on = word.ends_with('\\');
    if (carried_on) word.remove_suffix(1);
    if (!word.empty()) corners_.push_back(vertex_index(word));
  }
  if (corners_.size() < 3)
    throw FormatError(name_, line, fmt::format("expected a face of three or more vertices, found {}", corners_.size()));
  polygons_.append(soup_, corners_, groups_.tag(), line);
  material_tags_.resize(soup_.triangles.size(), materials_.tag());
}

// From 0. `word` is V, V/T, V//N or V/T/N; V counts from 1, or back from the last vertex so far when negative. Vertices
// may come after the faces that use them, so that the upper bound is checked at the end.
Vertex ObjReader::vertex_index(std::string_view word) const {
  const std::string_view digits = word.substr(0, word.find('/'));
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size()) scanner_.fail_expected("a vertex index", word);
  if (number == 0) scanner_.fail_expected("a vertex index, counted from 1 or back from -1", word);
  const auto so_far = static_cast<std::int64_t>(soup_.points.size());
  if (number < -so_far) scanner_.fail_expected(fmt::format("a vertex index among the {} so far", so_far), word);
  if (number > std::numeric_limits<Vertex>::max()) scanner_.fail_expected("a vertex index below 2^31", word);
  return static_cast<Vertex>(number < 0 ? so_far + number : number - 1);
}

void ObjReader::check_corners() const {
  for (std::size_t i = 0; i < soup_.triangles.size(); ++i) {
    const Vertex last = std::ranges::max(soup_.triangles[i]);
    if (static_cast<std::size_t>(last) >= soup_.points.size())
      throw FormatError(name_, soup_.places[i],
                        fmt::format("expected a vertex index up to {}, found {}", soup_.points.size(),
                                    static_cast<std::int64_t>(last) + 1));
  }
}

}  // namespace

bool is_obj_keyword(std::string_view word) {
  return std::ranges::find(keywords, word) != keywords.end();
}

SurfaceSoup read_obj(std::string_view text, const std::string& name) {
  return ObjReader(text, name).read();
}

}  // namespace hexpipe::formats
