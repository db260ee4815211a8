#include "tools/tessellate/freecad.hpp"

#include <fmt/format.h>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>
#include <gp_Vec.hxx>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/text_scanner.hpp"
#include "formats/streams/zip_archive.hpp"
#include "tools/tessellate/occt_names.hpp"

namespace hexpipe::tessellate {
namespace {

constexpr std::string_view archive_kind = "a FreeCAD file", objects_file = "Document.xml",
                           views_file = "GuiDocument.xml";
// Links may lead in a circle.
constexpr int most_levels = 32;

using FaceNames = std::vector<std::pair<int, std::string>>;  // by number from 1, in the order of the shape

// One of the tree.
struct Object {
  std::string name, type, label, shape_file;
  gp_Trsf placement;
  bool is_shown = true;
  std::vector<std::string> members;  // of a group, by name
  std::string tip;                   // of a body: the feature that has its shape
  std::string target, target_file;   // of a link; no file: the same document
  bool keeps_placement = false;      // of a link: the target's own placement counts, too
  bool is_array = false;             // of a link: its members, or these places, show the target
  std::string places_file;
  std::uint32_t colour = 0;
  std::string colours_file;  // of the faces
  FaceNames face_names;
  std::vector<std::string> uses;  // other objects, for whatever
};

pugi::xml_node value_of(const pugi::xml_node& property) {
  return property.find_child([](const pugi::xml_node& child) { return child.type() == pugi::node_element; });
}

gp_Trsf placed(const gp_Quaternion& rotation, const gp_Vec& translation) {
  gp_Trsf placement;
  if (rotation.SquareNorm() > 0) placement.SetRotation(rotation);
  placement.SetTranslationPart(translation);
  return placement;
}

gp_Trsf placement_of(const pugi::xml_node& value) {
  const auto number = [&](const char* name, double otherwise) { return value.attribute(name).as_double(otherwise); };
  return placed(gp_Quaternion(number("Q0", 0), number("Q1", 0), number("Q2", 0), number("Q3", 1)),
                gp_Vec(number("Px", 0), number("Py", 0), number("Pz", 0)));
}

class Document {
 public:
  Document(std::string_view bytes, std::string name, std::string path)
      : name_(std::move(name)), path_(std::move(path)) {
    for (auto& [file, text] : formats::unpack_zip(bytes, name_, archive_kind, [](std::string_view) { return true; }))
      files_.try_emplace(file, std::move(text));
    const pugi::xml_document objects = parsed(std::string(objects_file));
    for (const pugi::xml_node& object : objects.document_element().child("Objects").children("Object")) {
      const std::string id = object.attribute("name").value();
      if (objects_.try_emplace(id).second) order_.push_back(id);
      objects_[id].name = id;
      objects_[id].type = object.attribute("type").value();
    }
    for (const pugi::xml_node& data : objects.document_element().child("ObjectData").children("Object")) {
      const auto found = objects_.find(data.attribute("name").value());
      if (found == objects_.end()) continue;
      Object& object = found->second;
      for (const pugi::xml_node& property : data.child("Properties").children("Property")) {
        set(object, property);
        add_uses(object, value_of(property));
      }
      if (object.label.empty()) object.label = found->first;
    }
    if (files_.contains(views_file)) read_views(parsed(std::string(views_file)));
    for (const pugi::xml_node& data : objects.document_element().child("ObjectData").children("Object"))
      name_faces(data);
  }

  const std::string& name() const { return name_; }
  const std::string& path() const { return path_; }
  const std::vector<std::string>& order() const { return order_; }
  const Object* find(const std::string& id) const {
    const auto found = objects_.find(id);
    return found == objects_.end() ? nullptr : &found->second;
  }

  // Those that are in no group.
  std::vector<std::string> roots() const {
    std::set<std::string> members;
    for (const auto& [id, object] : objects_) members.insert(object.members.begin(), object.members.end());
    std::vector<std::string> roots;
    for (const std::string& id : order_)
      if (!members.contains(id)) roots.push_back(id);
    return roots;
  }

  // Null where the object has none yet.
  TopoDS_Shape shape_of(const Object& object) const {
    const std::string& text = file(object.shape_file);
    TopoDS_Shape shape;
    if (text.empty()) return shape;
    std::istringstream stream(text);
    if (object.shape_file.ends_with(".bin"))
      BinTools::Read(shape, stream);
    else
      BRepTools::Read(shape, stream, BRep_Builder());
    if (shape.IsNull())
      throw DataError::at(name_, "expected a shape in {}, found one that OpenCASCADE cannot read", object.shape_file);
    return shape;
  }

  // Of the copies in an array, as a number of copies and, for each, three coordinates and a quaternion.
  std::vector<gp_Trsf> places_of(const Object& array) const {
    const std::string& bytes = file(array.places_file);
    std::uint32_t count = 0;
    if (bytes.size() >= sizeof count) std::memcpy(&count, bytes.data(), sizeof count);
    std::vector<gp_Trsf> places;
    for (std::size_t i = 0; i < count; ++i) {
      const auto number = [&](std::size_t k) {
        double value = 0;
        float single = 0;
        const bool is_single = bytes.size() == sizeof count + count * 7 * sizeof single;
        const std::size_t size = is_single ? sizeof single : sizeof value, at = sizeof count + (7 * i + k) * size;
        if (at + size > bytes.size())
          throw DataError::at(name_, "expected {} places in {}, found fewer", count, array.places_file);
        std::memcpy(is_single ? static_cast<void*>(&single) : &value, bytes.data() + at, size);
        return is_single ? single : value;
      };
      places.push_back(
          placed(gp_Quaternion(number(3), number(4), number(5), number(6)), gp_Vec(number(0), number(1), number(2))));
    }
    return places;
  }

  // Those of the constraints come first; then come the colours, if there is more than the object's own one.
  FaceNames face_names_of(const Object& object, int faces) const {
    FaceNames names = object.face_names;
    if (const Object* tip = find(object.tip); tip != nullptr)
      names.insert(names.end(), tip->face_names.begin(), tip->face_names.end());
    if (object.colours_file.empty() || !files_.contains(object.colours_file)) return names;
    const std::string& bytes = file(object.colours_file);
    const auto colour_at = [&](std::size_t i) {
      std::uint32_t word = 0;
      std::memcpy(&word, bytes.data() + 4 * i, sizeof word);
      return word;
    };
    const auto count = static_cast<std::size_t>(faces);
    if (bytes.size() != 4 * (count + 1) || colour_at(0) != count) return names;
    for (std::size_t i = 1; i <= count; ++i)
      if (colour_at(i) >> 8 != object.colour >> 8)
        names.emplace_back(static_cast<int>(i), fmt::format("colour_{:06x}", colour_at(i) >> 8));
    return names;
  }

 private:
  const std::string& file(const std::string& name_in_zip) const {
    const auto found = files_.find(name_in_zip);
    if (found == files_.end())
      throw DataError::at(name_, "expected {} in the FreeCAD file, found none", formats::quote_found(name_in_zip));
    return found->second;
  }

  pugi::xml_document parsed(const std::string& name_in_zip) const {
    const std::string& text = file(name_in_zip);
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
    if (!result)
      throw DataError::at(name_, "expected well-formed XML in {}, found: {}", name_in_zip, result.description());
    return document;
  }

  static void set(Object& object, const pugi::xml_node& property) {
    const std::string_view name = property.attribute("name").value();
    const pugi::xml_node value = value_of(property);
    if (name == "Label") {
      object.label = value.attribute("value").value();
    } else if (name == "Shape") {
      object.shape_file = value.attribute("file").value();
    } else if (name == "LinkPlacement" || (name == "Placement" && object.placement.Form() == gp_Identity)) {
      object.placement = placement_of(value);
    } else if (name == "Visibility") {
      object.is_shown = value.attribute("value").as_bool(true);
    } else if (name == "Group" || name == "ElementList") {
      for (const pugi::xml_node& link : value.children("Link"))
        object.members.emplace_back(link.attribute("value").value());
    } else if (name == "Tip") {
      object.tip = value.attribute("value").value();
    } else if (name == "LinkedObject") {
      object.target = value.attribute("name") ? value.attribute("name").value() : value.attribute("value").value();
      object.target_file = value.attribute("file").value();
    } else if (name == "LinkTransform") {
      object.keeps_placement = value.attribute("value").as_bool(false);
    } else if (name == "ElementCount") {
      object.is_array = value.attribute("value").as_int(0) > 0;
    } else if (name == "PlacementList") {
      object.places_file = value.attribute("file").value();
    }
  }

  // Of properties of any type that lead to other objects.
  static void add_uses(Object& object, const pugi::xml_node& value) {
    if (!std::string_view(value.name()).starts_with("Link")) return;
    const auto add = [&](const pugi::xml_node& link) {
      for (const char* attribute : {"value", "obj"})
        if (link.attribute(attribute)) object.uses.emplace_back(link.attribute(attribute).value());
    };
    add(value);
    for (const pugi::xml_node& link : value.children()) add(link);
  }

  void read_views(const pugi::xml_document& views) {
    for (const pugi::xml_node& view : views.document_element().child("ViewProviderData").children("ViewProvider")) {
      const auto found = objects_.find(view.attribute("name").value());
      if (found == objects_.end()) continue;
      for (const pugi::xml_node& property : view.child("Properties").children("Property")) {
        const std::string_view name = property.attribute("name").value();
        const pugi::xml_node value = value_of(property);
        if (name == "Visibility")
          found->second.is_shown = value.attribute("value").as_bool(true);
        else if (name == "ShapeColor")
          found->second.colour = value.attribute("value").as_uint();
        else if (name == "DiffuseColor")
          found->second.colours_file = value.attribute("file").value();
      }
    }
  }

  // Gives faces the label of the FEM constraint that refers to them as "Face3" of an object.
  void name_faces(const pugi::xml_node& data) {
    const Object* constraint = find(data.attribute("name").value());
    if (constraint == nullptr || !constraint->type.starts_with("Fem::Constraint")) return;
    for (const pugi::xml_node& property : data.child("Properties").children("Property")) {
      if (std::string_view(property.attribute("name").value()) != "References") continue;
      for (const pugi::xml_node& link : value_of(property).children("Link")) {
        const auto found = objects_.find(link.attribute("obj").value());
        std::string_view part = link.attribute("sub").value();
        if (found == objects_.end() || !part.starts_with("Face")) continue;
        part.remove_prefix(4);
        int face = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), face);
        if (error == std::errc() && end == part.data() + part.size())
          found->second.face_names.emplace_back(face, constraint->label);
      }
    }
  }

  std::string name_, path_;
  std::map<std::string, std::string, std::less<>> files_;
  std::map<std::string, Object, std::less<>> objects_;
  std::vector<std::string> order_;
};

// What is in a part is hidden with the part. What is in a plain group hides and shows by itself.
bool is_plain_group(const Object& object) {
  return object.type.starts_with("App::DocumentObjectGroup");
}

class FreecadReader {
 public:
  FreecadReader(const std::string& bytes, const std::string& name, const std::string& path)
      : document_(open(bytes, name, path)) {
    builder_.MakeCompound(whole_);
  }

  CadModel read(TopoDS_Shape& whole) {
    for (const std::string& id : document_.roots()) visit(document_, id, gp_Trsf(), 0);
    if (model_.bodies.empty()) take_unused();
    whole = whole_;
    return std::move(model_);
  }

 private:
  Document& open(std::string_view bytes, const std::string& name, const std::string& path) {
    return documents_.try_emplace(path, bytes, name, path).first->second;
  }

  Document& open_linked(const Document& from, const Object& link) {
    const std::string path = (std::filesystem::path(from.path()).parent_path() / link.target_file).string();
    if (const auto known = documents_.find(path); known != documents_.end()) return known->second;
    if (!std::filesystem::exists(path))
      throw DataError::at(from.name(), "expected {}, to which the link '{}' leads, found no such file", path,
                          link.label);
    formats::Input input = formats::Input::open(path);
    return open(input.read_all(), path, path);
  }

  // What the object shows, within groups that are placed.
  void visit(const Document& document, const std::string& id, const gp_Trsf& around, int level) {
    const Object* object = document.find(id);
    if (object == nullptr || !(takes_hidden_ ? !used_.contains(id) : object->is_shown || is_plain_group(*object)))
      return;
    if (level > most_levels)
      throw DataError::at(document.name(), "expected at most {} levels of groups and links, found more at '{}'",
                          most_levels, object->label);
    show(document, *object, object->label, around, std::nullopt, level);
  }

  // `place` takes the place of the object's own placement.
  void show(const Document& document, const Object& object, const std::string& label, const gp_Trsf& around,
            const std::optional<gp_Trsf>& place, int level) {
    if (!object.target.empty()) return follow(document, object, around * place.value_or(object.placement), level);
    if (!object.shape_file.empty()) {
      TopoDS_Shape shape = document.shape_of(object);
      if (!shape.IsNull()) add(document, object, shape, label, around, place);
      return;
    }
    const gp_Trsf here = around * place.value_or(object.placement);
    for (const std::string& member : object.members) visit(document, member, here, level + 1);
  }

  // A link shows its target even where that is hidden.
  void follow(const Document& document, const Object& link, const gp_Trsf& here, int level) {
    if (level > most_levels)
      throw DataError::at(document.name(), "expected at most {} levels of groups and links, found more at '{}'",
                          most_levels, link.label);
    if (link.is_array && !link.members.empty()) {
      for (const std::string& member : link.members) visit(document, member, here, level + 1);
      return;
    }
    const Document& there = link.target_file.empty() ? document : open_linked(document, link);
    const Object* target = there.find(link.target);
    if (target == nullptr)
      throw DataError::at(document.name(), "expected the object {}, to which the link '{}' leads, found none",
                          formats::quote_found(link.target), link.label);
    const gp_Trsf own = link.keeps_placement ? target->placement : gp_Trsf();
    const std::vector<gp_Trsf> places = link.is_array ? document.places_of(link) : std::vector<gp_Trsf>(1);
    for (const gp_Trsf& place : places) show(there, *target, link.label, here * place, own, level + 1);
  }

  void add(const Document& document, const Object& object, TopoDS_Shape shape, const std::string& label,
           const gp_Trsf& around, const std::optional<gp_Trsf>& place) {
    if (place) shape.Location(TopLoc_Location(*place));
    if (around.Form() != gp_Identity) shape.Move(TopLoc_Location(around));
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    for (const auto& [number, name] : document.face_names_of(object, faces.Extent()))
      if (number >= 1 && number <= faces.Extent()) model_.names.set(faces(number), cad_name(name));
    for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
      model_.bodies.push_back({solid.Current(), cad_name(label)});
    if (faces.Extent() > 0) builder_.Add(whole_, shape);
  }

  // Hidden solids, but for those of which other solids are made.
  void take_unused() {
    takes_hidden_ = true;
    for (const std::string& id : document_.order()) {
      const Object& object = *document_.find(id);
      if (object.shape_file.empty()) continue;
      const TopoDS_Shape shape = document_.shape_of(object);
      if (!shape.IsNull() && TopExp_Explorer(shape, TopAbs_SOLID).More())
        used_.insert(object.uses.begin(), object.uses.end());
    }
    for (const std::string& id : document_.roots()) visit(document_, id, gp_Trsf(), 0);
    if (!model_.bodies.empty()) model_.warnings.push_back("the document shows no solid; hidden ones are taken");
  }

  std::map<std::string, Document> documents_;  // by path
  Document& document_;
  CadModel model_;
  BRep_Builder builder_;
  TopoDS_Compound whole_;
  bool takes_hidden_ = false;
  std::set<std::string> used_;  // objects of which the solids of others are made
};

}  // namespace

bool looks_like_freecad(std::string_view bytes) {
  constexpr std::size_t enough = 1 << 16;
  return bytes.starts_with("PK\3\4") && bytes.substr(0, enough).find(objects_file) != std::string_view::npos;
}

CadModel read_freecad(const std::string& bytes, const std::string& name, const std::string& path, TopoDS_Shape& whole) {
  return FreecadReader(bytes, name, path).read(whole);
}

}  // namespace hexpipe::tessellate
