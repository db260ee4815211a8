#pragma once
// A FreeCAD document as it is stored: objects with properties in XML, in a zip archive with their shapes in BREP.

#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <gp_Trsf.hxx>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hexpipe::tessellate {

// By number from 1, in the order of a shape's faces.
using FaceNames = std::vector<std::pair<int, std::string>>;

struct FreecadObject {
  std::string type, label;
  bool is_shown = true;
  std::optional<gp_Trsf> placement;
  std::string shape_file;                 // empty: it has no shape of its own
  std::vector<std::string> members;       // of a group, or of an array of links
  std::vector<std::string> operands;      // of which its shape is made
  std::string tip;                        // of a body: the feature whose shape the body has
  std::string target, target_file;        // of a link; no file: the same document
  std::string target_part;                // of a link to a part of its target
  bool adds_to_targets_place = false;     // of a link: it does not take the place of the target's own placement
  bool is_scaled = false;                 // of a link
  bool is_array = false;                  // of a link: it shows its members, or copies at places
  std::string places_file;                // of the copies
  std::optional<std::string> shown_list;  // of an array: '1' for each that is shown, the last one first
  std::uint32_t colour = 0;
  std::string colours_file;  // of the faces
  FaceNames face_names;      // by FEM constraints

  // What is in it is shown or hidden by itself, and lies where it would lie without it.
  bool is_plain_group() const { return type.starts_with("App::DocumentObjectGroup"); }
  bool shows(std::size_t element, std::size_t count) const {
    return !shown_list || shown_list->size() != count || (*shown_list)[count - 1 - element] != '0';
  }
};

class FreecadDocument {
 public:
  // Throws DataError for an archive that is damaged, and for one without objects.
  FreecadDocument(std::string_view bytes, std::string name, std::string path);

  const std::string& name() const { return name_; }
  const std::string& path() const { return path_; }  // empty: standard input
  const FreecadObject* find(const std::string& id) const;
  // Those that are in no group, by name, in their order.
  std::vector<std::string> roots() const;
  // Whether it says what is shown: FreeCAD without a window does not hide what other shapes are made of.
  bool has_views() const { return has_views_; }
  // Whether a shape with solids is made of the object's.
  bool is_operand(const std::string& id) const;
  // Whether the object is in a group that places it. It is listed in the plain groups there, too.
  bool is_in_part(const std::string& id) const { return in_parts_.contains(id); }

  // Null where the object has none yet. Throws DataError if it is missing or damaged.
  TopoDS_Shape shape_of(const FreecadObject& object) const;
  // Of the copies in an array.
  std::vector<gp_Trsf> places_of(const FreecadObject& array) const;
  // The names by constraints come first; then come the faces' own colours.
  FaceNames face_names_of(const FreecadObject& object, int faces) const;

 private:
  const std::string& file(const std::string& name_in_zip) const;
  pugi::xml_document parsed(const std::string& name_in_zip) const;
  void read_objects(const pugi::xml_node& document);
  void read_views(const pugi::xml_node& document);
  void name_faces(const std::string& label, const pugi::xml_node& references);

  std::string name_, path_;
  std::map<std::string, std::string, std::less<>> files_;
  std::map<std::string, FreecadObject, std::less<>> objects_;
  std::vector<std::string> order_;
  std::set<std::string, std::less<>> in_parts_;
  bool has_views_ = false;
  mutable std::map<std::string, TopoDS_Shape> shapes_;  // by file, once they were asked for
  mutable std::optional<std::set<std::string, std::less<>>> operands_;
};

}  // namespace hexpipe::tessellate
