#include "tools/tessellate/freecad_document.hpp"

#include <fmt/format.h>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <TopExp_Explorer.hxx>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <gp_Quaternion.hxx>
#include <gp_Vec.hxx>
#include <sstream>

#include "common/run/error.hpp"
#include "formats/streams/text_scanner.hpp"
#include "formats/streams/zip_archive.hpp"

namespace hexpipe::tessellate {
namespace {

constexpr const char *objects_file = "Document.xml", *views_file = "GuiDocument.xml";

// The properties by which a shape names those of which it is made.
constexpr std::array<std::string_view, 7> operand_properties{"Base",    "Tool",     "Shapes", "Links",
                                                             "Profile", "Sections", "Faces"};

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

bool is_one(const pugi::xml_node& scale) {
  for (const char* name : {"value", "valueX", "valueY", "valueZ"})
    if (scale.attribute(name) && scale.attribute(name).as_double(1) != 1) return false;
  return true;
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t offset) {
  Number number{};
  std::memcpy(&number, bytes.data() + offset, sizeof number);
  return number;
}

// The objects to which a property leads.
std::vector<std::string> links_in(const pugi::xml_node& value) {
  std::vector<std::string> links;
  const auto add = [&](const pugi::xml_node& link) {
    if (!std::string_view(link.name()).starts_with("Link")) return;
    for (const char* attribute : {"value", "obj"})
      if (const std::string_view id = link.attribute(attribute).value(); !id.empty()) links.emplace_back(id);
  };
  add(value);
  for (const pugi::xml_node& link : value.children()) add(link);
  return links;
}

// Calls visit(name, value) for each property of an object or of its view.
template <class Visit>
void for_properties(const pugi::xml_node& owner, Visit&& visit) {
  for (const pugi::xml_node& property : owner.child("Properties").children("Property"))
    visit(std::string_view(property.attribute("name").value()),
          property.find_child([](const pugi::xml_node& child) { return child.type() == pugi::node_element; }));
}

void set(FreecadObject& object, std::string_view name, const pugi::xml_node& value) {
  const pugi::xml_attribute simple = value.attribute("value");
  if (name == "Label") {
    object.label = simple.value();
  } else if (name == "Shape") {
    object.shape_file = value.attribute("file").value();
  } else if (name == "LinkPlacement" || (name == "Placement" && !object.placement)) {
    object.placement = placement_of(value);
  } else if (name == "Visibility") {
    object.is_shown = simple.as_bool(true);
  } else if (name == "Group" || name == "ElementList") {
    object.members = links_in(value);
  } else if (name == "Tip") {
    object.tip = simple.value();
  } else if (name == "LinkedObject") {
    object.target = value.attribute("name") ? value.attribute("name").value() : simple.value();
    object.target_file = value.attribute("file").value();
    object.target_part = value.attribute("sub").value();
  } else if (name == "LinkTransform") {
    object.adds_to_targets_place = simple.as_bool(false);
  } else if (name == "Scale" || name == "ScaleVector") {
    object.is_scaled = object.is_scaled || !is_one(value);
  } else if (name == "ElementCount" || name == "Count") {
    object.is_array = simple.as_int(0) > 0;
  } else if (name == "PlacementList") {
    object.places_file = value.attribute("file").value();
  } else if (name == "VisibilityList") {
    object.shown_list = simple.value();
  }
  if (std::ranges::count(operand_properties, name) > 0)
    for (std::string& id : links_in(value)) object.operands.push_back(std::move(id));
}

}  // namespace

FreecadDocument::FreecadDocument(std::string_view bytes, std::string name, std::string path)
    : name_(std::move(name)), path_(std::move(path)) {
  for (auto& [file, text] : formats::unpack_zip(bytes, name_, "a FreeCAD file", [](auto) { return true; }))
    files_.try_emplace(std::move(file), std::move(text));
  read_objects(parsed(objects_file).document_element());
  has_views_ = files_.contains(views_file);
  if (has_views_) read_views(parsed(views_file).document_element());
  for (const auto& [id, object] : objects_)
    if (!object.is_plain_group()) in_parts_.insert(object.members.begin(), object.members.end());
}

const std::string& FreecadDocument::file(const std::string& name_in_zip) const {
  const auto found = files_.find(name_in_zip);
  if (found == files_.end())
    throw DataError::at(name_, "expected {} in the FreeCAD file, found none", formats::quote_found(name_in_zip));
  return found->second;
}

pugi::xml_document FreecadDocument::parsed(const std::string& name_in_zip) const {
  const std::string& text = file(name_in_zip);
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (!result)
    throw DataError::at(name_, "expected well-formed XML in {}, found: {}", name_in_zip, result.description());
  return document;
}

void FreecadDocument::read_objects(const pugi::xml_node& document) {
  for (const pugi::xml_node& declared : document.child("Objects").children("Object")) {
    const std::string id = declared.attribute("name").value();
    const auto [object, is_new] = objects_.try_emplace(id);
    if (is_new) order_.push_back(id);
    object->second.type = declared.attribute("type").value();
  }
  std::vector<std::pair<std::string, pugi::xml_node>> constraints;  // by label
  for (const pugi::xml_node& data : document.child("ObjectData").children("Object")) {
    const auto found = objects_.find(data.attribute("name").value());
    if (found == objects_.end()) continue;
    FreecadObject& object = found->second;
    pugi::xml_node references;
    for_properties(data, [&](std::string_view name, const pugi::xml_node& value) {
      set(object, name, value);
      if (name == "References") references = value;
    });
    if (object.label.empty()) object.label = found->first;
    if (object.type.starts_with("Fem::Constraint")) constraints.emplace_back(object.label, references);
    // Arrays of links by the Draft workbench name their target so.
    if (object.shape_file.empty() && object.target.empty() && object.is_array && !object.operands.empty())
      object.target = object.operands.front();
  }
  for (const auto& [label, references] : constraints) name_faces(label, references);
}

// The constraint refers to a face as "Face3" of an object.
void FreecadDocument::name_faces(const std::string& label, const pugi::xml_node& references) {
  constexpr std::string_view prefix = "Face";
  for (const pugi::xml_node& link : references.children("Link")) {
    const auto found = objects_.find(link.attribute("obj").value());
    std::string_view part = link.attribute("sub").value();
    if (found == objects_.end() || !part.starts_with(prefix)) continue;
    part.remove_prefix(prefix.size());
    int face = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), face);
    if (error == std::errc() && end == part.data() + part.size()) found->second.face_names.emplace_back(face, label);
  }
}

void FreecadDocument::read_views(const pugi::xml_node& document) {
  for (const pugi::xml_node& view : document.child("ViewProviderData").children("ViewProvider")) {
    const auto found = objects_.find(view.attribute("name").value());
    if (found == objects_.end()) continue;
    FreecadObject& object = found->second;
    for_properties(view, [&](std::string_view name, const pugi::xml_node& value) {
      if (name == "Visibility")
        object.is_shown = value.attribute("value").as_bool(true);
      else if (name == "ShapeColor")
        object.colour = value.attribute("value").as_uint();
      else if (name == "DiffuseColor")
        object.colours_file = value.attribute("file").value();
    });
  }
}

const FreecadObject* FreecadDocument::find(const std::string& id) const {
  const auto found = objects_.find(id);
  return found == objects_.end() ? nullptr : &found->second;
}

std::vector<std::string> FreecadDocument::roots() const {
  std::set<std::string> members;
  for (const auto& [id, object] : objects_) members.insert(object.members.begin(), object.members.end());
  std::vector<std::string> roots;
  std::ranges::copy_if(order_, std::back_inserter(roots), [&](const std::string& id) { return !members.contains(id); });
  return roots;
}

bool FreecadDocument::is_operand(const std::string& id) const {
  if (!operands_) {
    operands_.emplace();
    for (const auto& [other, object] : objects_) {
      if (object.shape_file.empty() || object.operands.empty()) continue;
      const TopoDS_Shape shape = shape_of(object);
      if (!shape.IsNull() && TopExp_Explorer(shape, TopAbs_SOLID).More())
        operands_->insert(object.operands.begin(), object.operands.end());
    }
  }
  return operands_->contains(id);
}

TopoDS_Shape FreecadDocument::shape_of(const FreecadObject& object) const {
  const auto [known, is_new] = shapes_.try_emplace(object.shape_file);
  TopoDS_Shape& shape = known->second;
  if (!is_new) return shape;
  const std::string& text = file(object.shape_file);
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

// A number of copies and, for each, three coordinates and a quaternion, in either precision.
std::vector<gp_Trsf> FreecadDocument::places_of(const FreecadObject& array) const {
  constexpr std::size_t numbers = 7;
  const std::string& bytes = file(array.places_file);
  std::uint32_t count = 0;
  if (bytes.size() >= sizeof count) count = number_at<std::uint32_t>(bytes, 0);
  const std::size_t size = count == 0 ? 0 : (bytes.size() - sizeof count) / count / numbers;
  if (count > 0 && ((size != sizeof(float) && size != sizeof(double)) || bytes.size() != 4 + count * numbers * size))
    throw DataError::at(name_, "expected {} places in {}, found {} bytes", count, array.places_file, bytes.size());
  std::vector<gp_Trsf> places;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, numbers> values{};
    for (std::size_t k = 0; k < numbers; ++k) {
      const std::size_t at = sizeof count + (numbers * i + k) * size;
      values[k] = size == sizeof(float) ? number_at<float>(bytes, at) : number_at<double>(bytes, at);
    }
    const auto [x, y, z, q0, q1, q2, q3] = values;
    places.push_back(placed(gp_Quaternion(q0, q1, q2, q3), gp_Vec(x, y, z)));
  }
  return places;
}

FaceNames FreecadDocument::face_names_of(const FreecadObject& object, int faces) const {
  FaceNames names = object.face_names;
  if (const FreecadObject* tip = find(object.tip); tip != nullptr)
    names.insert(names.end(), tip->face_names.begin(), tip->face_names.end());
  if (object.colours_file.empty() || !files_.contains(object.colours_file)) return names;
  const std::string& bytes = file(object.colours_file);
  const auto colour_at = [&](std::size_t i) { return number_at<std::uint32_t>(bytes, 4 * i) >> 8; };
  const auto count = static_cast<std::size_t>(faces);
  if (bytes.size() != 4 * (count + 1) || number_at<std::uint32_t>(bytes, 0) != count) return names;
  for (std::size_t i = 1; i <= count; ++i)
    if (colour_at(i) != object.colour >> 8)
      names.emplace_back(static_cast<int>(i), fmt::format("colour_{:06x}", colour_at(i)));
  return names;
}

}  // namespace hexpipe::tessellate
