#include "formats/surfaces/threemf.hpp"

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
#include "formats/streams/text_scanner.hpp"
#include "formats/streams/zip_archive.hpp"
#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::formats {
namespace {

// Components in components may swell: those that place more are refused.
constexpr std::size_t most_placed = 100'000, most_triangles_placed = 100'000'000, most_points_placed = 300'000'000;
constexpr std::size_t most_name_bytes = std::size_t{1} << 28;
constexpr int most_levels = 32;

constexpr std::string_view usual_model = "3D/3dmodel.model", relations = "_rels/.rels";

// Where slicers keep what their parts are for, and the words for parts that are not bodies.
constexpr std::array<std::string_view, 2> slicer_settings{"metadata/model_settings.config",
                                                          "metadata/slic3r_pe_model.config"};
constexpr std::array<std::string_view, 4> slicer_parts{"negative_part", "modifier_part", "NegativeVolume",
                                                       "ParameterModifier"};

constexpr std::array<std::string_view, 3> known_extensions{
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"};

constexpr std::string_view xml_blanks = " \t\r\n";

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

std::string found_text(std::string_view text) {
  return text.empty() ? "none" : quote_found(text);
}

// Cuts off the first word, without the blanks around it; empty at the end.
std::string_view cut_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(xml_blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(xml_blanks));
  text.remove_prefix(word.size());
  return word;
}

// As XML Schema writes numbers: with blanks around them, and a sign that may be '+'.
template <class Number>
bool read_xml_number(std::string_view text, Number& value) {
  std::string_view word = cut_word(text);
  if (text.find_first_not_of(xml_blanks) != text.npos) return false;
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(static_cast<double>(value));
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

struct Part {
  std::string name;  // as the archive has it
  std::string text;
};

struct Package {
  std::map<std::string, Part, std::less<>> parts;  // by part_key() their names
  bool has_slicer_parts = false;
};

// Names of parts are equal whatever the case of their letters, and may be written as in addresses ("my%20part").
std::string part_key(std::string_view name) {
  while (name.starts_with('/')) name.remove_prefix(1);
  std::string key;
  for (std::size_t i = 0; i < name.size(); ++i) {
    unsigned char c = static_cast<unsigned char>(name[i]);
    if (c == '%' && i + 2 < name.size()) {
      const std::string_view digits = name.substr(i + 1, 2);
      unsigned char decoded = 0;
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + 2, decoded, 16);
      if (error == std::errc() && end == digits.data() + 2) c = decoded, i += 2;
    }
    key += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  }
  return key;
}

Package unpack(std::string_view bytes, const std::string& name) {
  const auto is_settings = [](const std::string& key) { return std::ranges::count(slicer_settings, key) > 0; };
  const auto is_wanted = [&](std::string_view name_in_zip) {
    const std::string key = part_key(name_in_zip);
    return key.ends_with(".model") || key == relations || is_settings(key);
  };
  Package package;
  for (auto& [name_in_zip, text] : unpack_zip(bytes, name, "a 3MF file", is_wanted)) {
    std::string key = part_key(name_in_zip);
    if (is_settings(key))
      package.has_slicer_parts =
          package.has_slicer_parts ||
          std::ranges::any_of(slicer_parts, [&](std::string_view part) { return text.find(part) != text.npos; });
    else
      package.parts[std::move(key)] = {std::move(name_in_zip), std::move(text)};
  }
  return package;
}

double millimetres_in(std::string_view unit, const std::string& file) {
  if (unit.empty() || unit == "millimeter") return 1;
  if (unit == "micron") return 0.001;
  if (unit == "centimeter") return 10;
  if (unit == "inch") return 25.4;
  if (unit == "foot") return 304.8;
  if (unit == "meter") return 1000;
  throw DataError::at(file, "expected micron, millimeter, centimeter, inch, foot or meter as the unit, found {}",
                      quote_found(unit));
}

class ThreemfReader {
 public:
  ThreemfReader(std::string_view bytes, const std::string& name) : file_(name), package_(unpack(bytes, name)) {}

  SurfaceSoup read() {
    Model& root = root_model();
    soup_.text = false;
    const std::string_view unit = attribute_of(root.node, "unit");
    unit_ = millimetres_in(unit, file_);
    for (const pugi::xml_node& item : child_of(root.node, "build").children())
      if (is_named(item, "item")) place(root, reference_in(root, item), Placement{}, 0);
    if (soup_.triangles.empty())
      throw DataError::at(file_, "expected a surface, found no triangles to build in the 3MF file");
    if (unit_ != 1) soup_.warnings.push_back(fmt::format("{}: its unit, {}, became millimetres", file_, unit));
    if (others_ > 0)
      soup_.warnings.push_back(
          fmt::format("{}: {} of type \"other\", as slicers' modifiers and negative parts are, {} left out", file_,
                      others_ == 1 ? "an object" : fmt::format("{} objects", others_), others_ == 1 ? "is" : "are"));
    else if (package_.has_slicer_parts)
      soup_.warnings.push_back(
          fmt::format("{}: has modifiers or negative parts of a slicer; they are read as bodies", file_));
    soup_.has_own_tags = true;
    return std::move(soup_);
  }

 private:
  // An item of the build, or a component of an object.
  struct Reference {
    pugi::xml_node node;
    std::string_view id, path;  // the path is empty for the same model
    Placement placement;
  };
  // Read once, however often it is placed.
  struct Object {
    pugi::xml_node node;
    bool is_read = false;
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
    std::vector<std::int32_t> groups;  // of the triangles, from 0
    std::vector<std::string> names;    // of the groups
    std::vector<Reference> components;
  };
  struct Model {
    pugi::xml_document document;
    std::vector<std::size_t> line_ends;
    std::string name;
    pugi::xml_node node;
    std::map<std::string_view, Object, std::less<>> objects;  // by id
    // By id, the names of base materials, and the colours.
    std::map<std::string_view, std::vector<std::string>, std::less<>> properties;
  };

  Model& root_model() {
    std::string name(usual_model);
    if (const auto rels = package_.parts.find(relations); rels != package_.parts.end()) {
      pugi::xml_document document;
      if (document.load_buffer(rels->second.text.data(), rels->second.text.size()))
        for (const pugi::xml_node& relation : document.document_element().children())
          if (attribute_of(relation, "Type").ends_with("/3dmodel")) {
            name = attribute_of(relation, "Target");
            break;
          }
    }
    if (!package_.parts.contains(part_key(name)))
      throw DataError::at(file_, "expected a surface, found a 3MF file without a model");
    return model_at(name);
  }

  [[noreturn]] void fail(const Model& model, const pugi::xml_node& node, std::string_view what) const {
    const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0));
    const auto line = std::ranges::lower_bound(model.line_ends, offset) - model.line_ends.begin() + 1;
    throw DataError::at(file_, "in {}, line {}: {}", model.name, line, what);
  }

  Model& model_at(std::string_view path) {
    const std::string key = part_key(path);
    const auto [known, is_new] = models_.try_emplace(key);
    Model& model = known->second;
    if (!is_new) return model;
    const auto found = package_.parts.find(key);
    if (found == package_.parts.end())
      throw DataError::at(file_, "expected {} in the 3MF file, found none", quote_found(path));
    model.name = clean_name(found->second.name);
    const std::string text = std::exchange(found->second.text, {});
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
      model.line_ends.push_back(at);
    const pugi::xml_parse_result parsed = model.document.load_buffer(text.data(), text.size());
    if (!parsed)
      throw DataError::at(file_, "expected well-formed XML in {}, found: {}", model.name, parsed.description());
    model.node = model.document.document_element();
    if (!is_named(model.node, "model")) fail(model, model.node, "expected <model>");
    check_extensions(model);
    for (const pugi::xml_node& resource : child_of(model.node, "resources").children()) {
      const std::string_view id = attribute_of(resource, "id");
      if (is_named(resource, "object")) {
        model.objects.try_emplace(id).first->second.node = resource;
      } else if (const auto [group, is_first] = model.properties.try_emplace(id); is_first) {
        for (const pugi::xml_node& entry : resource.children()) {
          const std::string_view name = attribute_of(entry, "name");
          group->second.push_back(clean_name(name.empty() ? attribute_of(entry, "color") : name));
        }
      }
    }
    return model;
  }

  // Beams, slices and other shapes that are not meshes cannot be left out: the file says that readers must know them.
  void check_extensions(const Model& model) const {
    std::string_view prefixes = attribute_of(model.node, "requiredextensions");
    for (std::string_view prefix = cut_word(prefixes); !prefix.empty(); prefix = cut_word(prefixes)) {
      std::string_view extension = model.node.attribute(fmt::format("xmlns:{}", prefix).c_str()).value();
      if (extension.empty()) extension = prefix;
      if (std::ranges::count(known_extensions, extension) > 0) continue;
      // All of them begin with this, which would leave no place for the name.
      constexpr std::string_view usual_start = "/3dmanufacturing/";
      if (const std::size_t at = extension.find(usual_start); at != extension.npos)
        extension.remove_prefix(at + usual_start.size());
      throw DataError::at(file_, "expected a 3MF file of meshes alone, found one that needs the extension {}",
                          quote_found(extension));
    }
  }

  Reference reference_in(const Model& model, const pugi::xml_node& node) const {
    // Where the production extension says so, an object is in another file of the archive.
    Reference reference{node, attribute_of(node, "objectid"), attribute_of(node, "path"), {}};
    std::string_view text = attribute_of(node, "transform");
    if (text.empty()) return reference;
    for (double& value : reference.placement.m)
      if (!read_xml_number(cut_word(text), value)) fail(model, node, "expected twelve numbers in transform");
    if (!cut_word(text).empty()) fail(model, node, "expected twelve numbers in transform, found more");
    return reference;
  }

  void place(Model& from, const Reference& reference, const Placement& around, int level) {
    Model& model = reference.path.empty() ? from : model_at(reference.path);
    if (level > most_levels || ++placed_ > most_placed)
      throw DataError::at(file_, "expected at most {} objects in {} levels of components, found more", most_placed,
                          most_levels);
    const auto found = model.objects.find(reference.id);
    if (found == model.objects.end())
      fail(from, reference.node,
           reference.id.empty() ? "expected an objectid, found none"
                                : fmt::format("expected an object {}, found none", quote_found(reference.id)));
    Object& object = found->second;
    const std::string_view type = attribute_of(object.node, "type");
    if (type == "support" || type == "solidsupport") return;
    if (type == "other") {
      ++others_;
      return;
    }
    if (!object.is_read) read_object(model, object);
    const Placement here = reference.placement.then(around);
    append(object, here);
    for (const Reference& component : object.components) place(model, component, here, level + 1);
  }

  void read_object(const Model& model, Object& object) const {
    object.is_read = true;
    const pugi::xml_node mesh = child_of(object.node, "mesh"), components = child_of(object.node, "components");
    if (!mesh && !components) fail(model, object.node, "expected a mesh or components");
    if (mesh) read_mesh(model, mesh, object);
    for (const pugi::xml_node& component : components.children())
      if (is_named(component, "component")) object.components.push_back(reference_in(model, component));
  }

  template <class Number>
  Number number_of(const Model& model, const pugi::xml_node& node, std::string_view attribute) const {
    const std::string_view text = attribute_of(node, attribute);
    Number value{};
    if (!read_xml_number(text, value))
      fail(model, node, fmt::format("expected a number as {}, found {}", attribute, found_text(text)));
    return value;
  }

  void read_mesh(const Model& model, const pugi::xml_node& mesh, Object& object) const {
    for (const pugi::xml_node& vertex : child_of(mesh, "vertices").children()) {
      if (!is_named(vertex, "vertex")) continue;
      const auto coordinate = [&](const char* axis) { return number_of<double>(model, vertex, axis); };
      object.points.push_back(Vec3{coordinate("x"), coordinate("y"), coordinate("z")});
    }
    check_point_count(object.points.size(), file_);
    const auto count = static_cast<std::int64_t>(object.points.size());
    GroupFinder groups(model, object);
    for (const pugi::xml_node& triangle : child_of(mesh, "triangles").children()) {
      if (!is_named(triangle, "triangle")) continue;
      Triangle corners;
      for (std::size_t i = 0; i < 3; ++i) {
        constexpr const char* names[] = {"v1", "v2", "v3"};
        const auto v = number_of<std::int64_t>(model, triangle, names[i]);
        if (v < 0 || v >= count)
          fail(model, triangle, fmt::format("expected a vertex from 0 to {}, found {}", count - 1, v));
        corners[i] = static_cast<Vertex>(v);
      }
      object.triangles.push_back(corners);
      object.groups.push_back(groups.of(triangle));
    }
  }

  // Triangles with a material or colour of their own are a group of their own. Gradients are not: their corners differ.
  class GroupFinder {
   public:
    GroupFinder(const Model& model, Object& object)
        : model_(model),
          object_(object),
          own_group_(attribute_of(object.node, "pid")),
          own_(property_name(own_group_, attribute_of(object.node, "pindex"))) {}

    std::int32_t of(const pugi::xml_node& triangle) {
      Key key{attribute_of(triangle, "pid"), attribute_of(triangle, "p1")};
      for (const std::string_view other : {attribute_of(triangle, "p2"), attribute_of(triangle, "p3")})
        if (!other.empty() && other != key.second) return number_of_property({});
      if (key == Key()) return number_of_property({});
      const auto [known, is_new] = known_.try_emplace(key);
      if (is_new) {
        std::string property =
            property_name(key.first.empty() ? own_group_ : key.first, key.second.empty() ? "0" : key.second);
        known->second = number_of_property(property == own_ ? std::string() : std::move(property));
      }
      return known->second;
    }

   private:
    using Key =
        std::pair<std::string_view, std::string_view>;  // of a triangle: the id of the property group, the index

    std::int32_t number_of_property(const std::string& property) {
      const auto [known, is_new] = numbers_.try_emplace(property, static_cast<std::int32_t>(numbers_.size()));
      if (is_new) {
        std::string name = clean_name(attribute_of(object_.node, "name"));
        if (!property.empty()) name += (name.empty() ? "" : " ") + property;
        object_.names.push_back(std::move(name));
      }
      return known->second;
    }

    // The name of a base material, or the colour; empty where there is none.
    std::string property_name(std::string_view group, std::string_view index) const {
      if (group.empty()) return {};
      std::size_t number = 0;
      read_xml_number(index, number);
      const auto found = model_.properties.find(group);
      if (found != model_.properties.end() && number < found->second.size()) return found->second[number];
      return clean_name(fmt::format("{}:{}", group, index));
    }

    const Model& model_;
    Object& object_;
    std::string_view own_group_;
    std::string own_;
    std::map<Key, std::int32_t> known_;
    std::map<std::string, std::int32_t> numbers_;  // of the object's groups, by property
  };

  void append(const Object& object, const Placement& place) {
    if (object.triangles.empty()) return;
    if (object.points.size() > most_points_placed - soup_.points.size())
      throw DataError::at(file_, "expected at most {} points, found more", most_points_placed);
    if (object.triangles.size() > most_triangles_placed - soup_.triangles.size())
      throw DataError::at(file_, "expected at most {} triangles, found more", most_triangles_placed);
    const auto first = static_cast<Vertex>(soup_.points.size());
    for (const Vec3& p : object.points) soup_.points.push_back(unit_ * place(p));
    const bool mirrored = place.mirrors();
    for (std::size_t t = 0; t < object.triangles.size(); ++t) {
      auto [a, b, c] = object.triangles[t];
      if (mirrored) std::swap(b, c);
      append_triangle(soup_, {first + a, first + b, first + c}, last_tag_ + 1 + object.groups[t], ++last_place_);
    }
    for (const std::string& name : object.names) {
      ++last_tag_;
      if (name.empty()) continue;
      if ((name_bytes_ += name.size()) > most_name_bytes)
        throw DataError::at(file_, "expected names of at most {} bytes, found more", most_name_bytes);
      soup_.names.surfaces[last_tag_] = name;
    }
  }

  const std::string& file_;
  Package package_;
  std::map<std::string, Model> models_;  // by part_key() their names
  SurfaceSoup soup_;
  double unit_ = 1;
  std::size_t placed_ = 0, others_ = 0, name_bytes_ = 0;
  std::int32_t last_tag_ = 0;
  std::int64_t last_place_ = 0;
};

}  // namespace

bool looks_like_3mf(std::string_view bytes) {
  constexpr std::size_t enough = 1 << 16;  // the names are at the beginning of files, and again at the archive's end
  if (!bytes.starts_with("PK\x03\x04")) return false;
  const auto has = [&](std::string_view part) {
    const std::string key = part_key(part);
    return key.find("3d/") != key.npos && key.find(".model") != key.npos;
  };
  return has(bytes.substr(0, enough)) || has(bytes.substr(bytes.size() - std::min(enough, bytes.size())));
}

SurfaceSoup read_3mf(std::string_view bytes, const std::string& name) {
  return ThreemfReader(bytes, name).read();
}

}  // namespace hexpipe::formats
