#include "formats/surfaces/threemf.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <pugixml.hpp>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "formats/streams/group_names.hpp"
#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

// Archives may swell: models of more bytes, and components in components that place more, are refused.
constexpr std::size_t most_model_bytes = std::size_t{1} << 31;
constexpr std::size_t usual_swelling = 250, harmless_bytes = std::size_t{1} << 28;
constexpr std::size_t most_placed = 100'000, most_triangles_placed = 100'000'000;
constexpr int most_levels = 32;

constexpr std::string_view usual_model = "3D/3dmodel.model";

// Names of XML may have a prefix for their namespace, which each file chooses.
std::string_view local_name(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

bool is_named(const pugi::xml_node& node, std::string_view name) {
  return local_name(node.name()) == name;
}

pugi::xml_node child_of(const pugi::xml_node& node, std::string_view name) {
  return node.find_child([&](const pugi::xml_node& child) { return is_named(child, name); });
}

std::string_view attribute_of(const pugi::xml_node& node, std::string_view name) {
  return node.find_attribute([&](const pugi::xml_attribute& a) { return local_name(a.name()) == name; }).value();
}

// x' = x m[0] + y m[3] + z m[6] + m[9], and so on.
struct Placement {
  std::array<double, 12> m{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

  Vec3 operator()(const Vec3& p) const {
    const auto along = [&](std::size_t i) { return p.x * m[i] + p.y * m[3 + i] + p.z * m[6 + i] + m[9 + i]; };
    return {along(0), along(1), along(2)};
  }
  bool mirrors() const { return det(Vec3{m[0], m[1], m[2]}, Vec3{m[3], m[4], m[5]}, Vec3{m[6], m[7], m[8]}) < 0; }
  // First this one, then the other.
  Placement then(const Placement& other) const {
    Placement both;
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t i = 0; i < 3; ++i)
        both.m[3 * row + i] = m[3 * row] * other.m[i] + m[3 * row + 1] * other.m[3 + i] +
                              m[3 * row + 2] * other.m[6 + i] + (row == 3 ? other.m[9 + i] : 0);
    return both;
  }
};

using Models = std::map<std::string, std::string, std::less<>>;  // the text of each, by its path

struct ArchiveEnd {
  void operator()(archive* a) const { archive_read_free(a); }
};

std::string path_of(std::string_view path) {
  while (path.starts_with('/')) path.remove_prefix(1);
  return std::string(path);
}

Models unpack(std::string_view bytes, const std::string& name) {
  const std::unique_ptr<archive, ArchiveEnd> zip(archive_read_new());
  if (!zip) throw std::bad_alloc();
  const auto fail = [&]() {
    const char* said = archive_error_string(zip.get());
    throw DataError::at(name, "expected a whole 3MF file, found a damaged zip archive: {}", said ? said : "no entry");
  };
  archive_read_support_format_zip(zip.get());
  if (archive_read_open_memory(zip.get(), bytes.data(), bytes.size()) != ARCHIVE_OK) fail();
  Models models;
  const std::size_t most = std::min(most_model_bytes, std::max(harmless_bytes, usual_swelling * bytes.size()));
  std::size_t total = 0;
  std::array<char, 1 << 16> chunk;
  for (archive_entry* entry = nullptr;;) {
    const int result = archive_read_next_header(zip.get(), &entry);
    if (result == ARCHIVE_EOF) return models;
    if (result < ARCHIVE_WARN) fail();
    const char* const path = archive_entry_pathname(entry);
    const std::string_view name_in_zip = path ? path : "";
    if (!name_in_zip.ends_with(".model") && name_in_zip != "_rels/.rels") continue;
    std::string& text = models[path_of(name_in_zip)];
    text.clear();
    for (;;) {
      const la_ssize_t got = archive_read_data(zip.get(), chunk.data(), chunk.size());
      if (got < 0) fail();
      if (got == 0) break;
      text.append(chunk.data(), static_cast<std::size_t>(got));
      if ((total += static_cast<std::size_t>(got)) > most)
        throw DataError::at(name, "expected models of at most {} bytes in the 3MF file, found more", most);
    }
  }
}

double millimetres_in(std::string_view unit, const std::string& file) {
  if (unit.empty() || unit == "millimeter") return 1;
  if (unit == "micron") return 0.001;
  if (unit == "centimeter") return 10;
  if (unit == "inch") return 25.4;
  if (unit == "foot") return 304.8;
  if (unit == "meter") return 1000;
  throw DataError::at(file, "expected micron, millimeter, centimeter, inch, foot or meter as the unit, found '{}'",
                      unit);
}

class ThreemfReader {
 public:
  ThreemfReader(std::string_view bytes, const std::string& name) : file_(name), models_(unpack(bytes, name)) {}

  SurfaceSoup read() {
    const std::string root = root_path();
    const Model& model = model_at(root);
    soup_.text = false;
    unit_ = millimetres_in(attribute_of(model.root, "unit"), file_);
    for (const pugi::xml_node& item : child_of(model.root, "build").children())
      if (is_named(item, "item")) place(path_in(item, root), item, Placement{}, 0);
    if (soup_.triangles.empty())
      throw DataError::at(file_, "expected a surface, found no triangles to build in the 3MF file");
    if (unit_ != 1)
      soup_.warnings.push_back(
          fmt::format("{}: its unit, {}, became millimetres", file_, attribute_of(model.root, "unit")));
    soup_.has_own_tags = true;
    return std::move(soup_);
  }

 private:
  struct Model {
    pugi::xml_document document;
    std::vector<std::size_t> line_ends;
    std::string path;
    pugi::xml_node root, resources;
    std::map<std::string_view, pugi::xml_node, std::less<>> objects;  // by id
  };

  std::string root_path() {
    if (const auto rels = models_.find("_rels/.rels"); rels != models_.end()) {
      pugi::xml_document document;
      if (document.load_buffer(rels->second.data(), rels->second.size()))
        for (const pugi::xml_node& relation : document.document_element().children())
          if (attribute_of(relation, "Type").ends_with("/3dmodel")) return path_of(attribute_of(relation, "Target"));
    }
    return std::string(usual_model);
  }

  // Where the production extension says so, an object is in another file of the archive.
  static std::string path_in(const pugi::xml_node& node, const std::string& path) {
    const std::string_view other = attribute_of(node, "path");
    return other.empty() ? path : path_of(other);
  }

  [[noreturn]] void fail(const Model& model, const pugi::xml_node& node, std::string_view what) const {
    const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
    const auto line = std::ranges::lower_bound(model.line_ends, offset) - model.line_ends.begin() + 1;
    throw DataError::at(file_, "in {}, line {}: {}", model.path, line, what);
  }

  const Model& model_at(const std::string& path) {
    const auto [known, is_new] = read_.try_emplace(path);
    Model& model = known->second;
    if (!is_new) return model;
    const auto text = models_.find(path);
    if (text == models_.end()) throw DataError::at(file_, "expected {} in the 3MF file, found none", clean_name(path));
    model.path = clean_name(path);
    for (std::size_t at = text->second.find('\n'); at != std::string::npos; at = text->second.find('\n', at + 1))
      model.line_ends.push_back(at);
    const pugi::xml_parse_result parsed = model.document.load_buffer(text->second.data(), text->second.size());
    text->second = std::string();
    if (!parsed)
      throw DataError::at(file_, "expected well-formed XML in {}, found: {}", model.path, parsed.description());
    model.root = model.document.document_element();
    if (!is_named(model.root, "model")) fail(model, model.root, "expected <model>");
    model.resources = child_of(model.root, "resources");
    for (const pugi::xml_node& object : model.resources.children())
      if (is_named(object, "object")) model.objects.try_emplace(attribute_of(object, "id"), object);
    return model;
  }

  // `reference` is an item of the build, or a component of an object.
  void place(const std::string& path, const pugi::xml_node& reference, const Placement& around, int level) {
    const Model& model = model_at(path);
    if (level > most_levels || ++placed_ > most_placed)
      throw DataError::at(file_, "expected at most {} objects in {} levels of components, found more", most_placed,
                          most_levels);
    const std::string_view id = attribute_of(reference, "objectid");
    const auto found = model.objects.find(id);
    if (found == model.objects.end())
      fail(model, model.resources, fmt::format("expected an object {}, found none", clean_name(id)));
    const pugi::xml_node object = found->second;
    const std::string_view type = attribute_of(object, "type");
    if (type == "support" || type == "solidsupport") return;
    const Placement here = placement_of(model, reference).then(around);
    if (const pugi::xml_node mesh = child_of(object, "mesh")) add_mesh(model, object, mesh, here);
    for (const pugi::xml_node& component : child_of(object, "components").children())
      if (is_named(component, "component")) place(path_in(component, path), component, here, level + 1);
  }

  Placement placement_of(const Model& model, const pugi::xml_node& node) const {
    Placement placement;
    std::string_view text = attribute_of(node, "transform");
    if (text.empty()) return placement;
    for (double& value : placement.m) {
      text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || !std::isfinite(value)) fail(model, node, "expected twelve numbers in transform");
      text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
    return placement;
  }

  template <class Number>
  Number number_of(const Model& model, const pugi::xml_node& node, std::string_view attribute) const {
    const std::string_view text = attribute_of(node, attribute);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(static_cast<double>(value)))
      fail(model, node, fmt::format("expected a number as {}, found '{}'", attribute, clean_name(text)));
    return value;
  }

  void add_mesh(const Model& model, const pugi::xml_node& object, const pugi::xml_node& mesh, const Placement& place) {
    const auto first = static_cast<std::int64_t>(soup_.points.size());
    for (const pugi::xml_node& vertex : child_of(mesh, "vertices").children()) {
      if (!is_named(vertex, "vertex")) continue;
      const auto coordinate = [&](const char* axis) { return number_of<double>(model, vertex, axis); };
      soup_.points.push_back(unit_ * place(Vec3{coordinate("x"), coordinate("y"), coordinate("z")}));
    }
    check_point_count(soup_.points.size(), file_);
    const std::int64_t count = static_cast<std::int64_t>(soup_.points.size()) - first;
    std::map<std::string, std::int32_t> tags;  // of this mesh, by property
    const bool mirrored = place.mirrors();
    for (const pugi::xml_node& triangle : child_of(mesh, "triangles").children()) {
      if (!is_named(triangle, "triangle")) continue;
      Triangle corners;
      for (std::size_t i = 0; i < 3; ++i) {
        constexpr const char* names[] = {"v1", "v2", "v3"};
        const auto v = number_of<std::int64_t>(model, triangle, names[i]);
        if (v < 0 || v >= count)
          fail(model, triangle, fmt::format("expected a vertex from 0 to {}, found {}", count - 1, v));
        corners[i] = static_cast<Vertex>(first + v);
      }
      if (mirrored) std::swap(corners[1], corners[2]);
      if (soup_.triangles.size() >= most_triangles_placed)
        throw DataError::at(file_, "expected at most {} triangles, found more", most_triangles_placed);
      append_triangle(soup_, corners, tag_of(model, object, triangle, tags), ++last_place_);
    }
  }

  // Triangles with a material or colour of their own are a group of their own.
  std::int32_t tag_of(const Model& model, const pugi::xml_node& object, const pugi::xml_node& triangle,
                      std::map<std::string, std::int32_t>& tags) {
    std::string property;
    if (const std::string_view group = attribute_of(triangle, "pid"), index = attribute_of(triangle, "p1");
        !index.empty() || !group.empty())
      property = property_name(model, group.empty() ? attribute_of(object, "pid") : group, index.empty() ? "0" : index);
    if (property == property_name(model, attribute_of(object, "pid"), attribute_of(object, "pindex"))) property.clear();
    const auto [known, is_new] = tags.try_emplace(property, last_tag_ + 1);
    if (is_new) {
      ++last_tag_;
      std::string name = clean_name(attribute_of(object, "name"));
      if (!property.empty()) name += (name.empty() ? "" : " ") + property;
      if (!name.empty()) soup_.names.surfaces[last_tag_] = std::move(name);
    }
    return known->second;
  }

  // The name of a base material, or the colour; empty where there is none.
  static std::string property_name(const Model& model, std::string_view group, std::string_view index) {
    if (group.empty()) return {};
    std::size_t number = 0;
    std::from_chars(index.data(), index.data() + index.size(), number);
    for (const pugi::xml_node& resource : model.resources.children()) {
      if (is_named(resource, "object") || attribute_of(resource, "id") != group) continue;
      for (const pugi::xml_node& entry : resource.children()) {
        if (number-- > 0) continue;
        const std::string_view name = attribute_of(entry, "name"), colour = attribute_of(entry, "color");
        return clean_name(name.empty() ? colour : name);
      }
    }
    return clean_name(fmt::format("{}:{}", group, index));
  }

  const std::string& file_;
  Models models_;
  std::map<std::string, Model> read_;
  SurfaceSoup soup_;
  double unit_ = 1;
  std::size_t placed_ = 0;
  std::int32_t last_tag_ = 0;
  std::int64_t last_place_ = 0;
};

}  // namespace

bool looks_like_3mf(std::string_view bytes) {
  constexpr std::size_t enough = 1 << 16;  // the names are at the beginning of files, and again at the archive's end
  if (!bytes.starts_with("PK\x03\x04")) return false;
  const auto has = [&](std::string_view part) {
    return part.find("3D/") != part.npos && part.find(".model") != part.npos;
  };
  return has(bytes.substr(0, enough)) || has(bytes.substr(bytes.size() - std::min(enough, bytes.size())));
}

SurfaceSoup read_3mf(std::string_view bytes, const std::string& name) {
  return ThreemfReader(bytes, name).read();
}

}  // namespace hexpipe::formats
