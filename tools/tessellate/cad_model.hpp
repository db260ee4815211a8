#pragma once
// A CAD model: how it is read (STEP, IGES, BREP and FreeCAD, recognized by content), its bodies, and the names of its
// shapes.

#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "formats/streams/input.hpp"

namespace hexpipe::tessellate {

// Names by shape, wherever the shape is placed: the faces of all instances of a part have the same name.
class ShapeNames {
 public:
  // The first name stays.
  void set(const TopoDS_Shape& shape, std::string name) {
    if (!shape.IsNull() && !name.empty()) names_.try_emplace(shape.TShape().get(), Entry{shape, std::move(name)});
  }
  // Empty if it has no name.
  std::string of(const TopoDS_Shape& shape) const {
    const auto found = shape.IsNull() ? names_.end() : names_.find(shape.TShape().get());
    return found == names_.end() ? std::string() : found->second.name;
  }

 private:
  struct Entry {
    TopoDS_Shape shape;  // keeps the address its own
    std::string name;
  };
  std::map<const void*, Entry> names_;
};

// Passes names from the parts of a shape to the parts that a change made of them: changed(part, set) calls set(made)
// for each of these.
template <class ChangeOf>
void carry_names(const TopoDS_Shape& shape, ShapeNames& names, ChangeOf&& changed) {
  for (const TopAbs_ShapeEnum type : {TopAbs_FACE, TopAbs_EDGE})
    for (TopExp_Explorer part(shape, type); part.More(); part.Next()) {
      const std::string name = names.of(part.Current());
      if (!name.empty()) changed(part.Current(), [&](const TopoDS_Shape& made) { names.set(made, name); });
    }
}

struct CadBody {
  TopoDS_Shape solid;
  std::string name;        // may be empty
  std::size_t number = 0;  // in the file, from 1, for messages
};

// The length of a unit.
struct LengthUnit {
  std::string name = "millimetre";
  double millimetres = 1;
};

struct CadModel {
  std::vector<CadBody> bodies;       // in millimetres, or in the file's own unit if it names none
  std::vector<TopoDS_Shape> sheets;  // faces beside bodies, which belong to none; likewise
  ShapeNames names;                  // of faces and edges
  LengthUnit unit;                   // of the file
  bool names_unit = true;
  std::vector<std::string> warnings;  // what was healed or left out
};

// OpenCASCADE's message about a failure, or at least its kind.
std::string message_of(const Standard_Failure& failure);

// "1 face", "2 faces".
std::string counted(int count, const char* noun);

// The end of a message about faces that do not enclose bodies, or whose triangles do not.
inline constexpr const char* way_out = " (--open writes its faces for wrap, which closes gaps)";

// Throws DataError if the file is empty, cut off, not CAD, or without bodies, if it needs some. Closed shells and faces
// that can be sewn to such become bodies then, with a warning.
CadModel read_cad(formats::Input& input, bool needs_bodies);

// For files without solids: closed shells become bodies, loose faces are sewn. Throws DataError if that gives nothing
// closed.
void make_bodies(const TopoDS_Shape& whole, const std::string& source, CadModel& model);

// Leaves those bodies that have one of these names or, where none has it, numbers (from 1, in the order of the file),
// which then are numbered anew. Throws DataError for a name that is neither.
void keep_bodies(const std::vector<std::string>& wanted, const std::string& source, CadModel& model);

TopoDS_Compound compound_of(const CadModel& model);

// Makes one body of all bodies and sheets, which need not be closed. Throws DataError if there are no faces.
void put_together(const std::string& source, CadModel& model);

// Heals the bodies that OpenCASCADE finds faulty, with a warning.
void heal_bodies(CadModel& model);

// Adds the faces of the whole that belong to no solid to the sheets.
void find_sheets(const TopoDS_Shape& whole, CadModel& model);

}  // namespace hexpipe::tessellate
