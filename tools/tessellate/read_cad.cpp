#include "tools/tessellate/cad_model.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IGESBasic_SubfigureDef.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_ExternFile.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>

#include "common/run/error.hpp"
#include "formats/streams/foreign_files.hpp"
#include "formats/streams/text_scanner.hpp"
#include "tools/tessellate/freecad.hpp"
#include "tools/tessellate/occt_names.hpp"
#include "tools/tessellate/step_files.hpp"

namespace hexpipe::tessellate {
namespace {

constexpr std::string_view expected = "expected CAD in STEP, IGES, BREP or FreeCAD's FCStd";
constexpr std::string_view step_begin = "ISO-10303-21";

// Whether a line of IGES ends with the number 1 behind the letter of its section. Some programs fill numbers up by
// blanks, others by zeros.
bool is_first_of_section(char section, std::string_view line) {
  if (!line.ends_with('1')) return false;
  line.remove_suffix(1);
  const std::size_t last = line.find_last_not_of(" 0");
  return last != std::string_view::npos && line[last] == section;
}

bool looks_like_iges(std::string_view bytes) {
  return bytes.size() > 80 && bytes.substr(0, 80).find('\n') == std::string_view::npos && bytes[72] == 'S' &&
         is_first_of_section('S', bytes.substr(0, 80));
}

// The last section has one line. Blank lines and the end mark of DOS may follow it.
bool ends_as_iges(std::string_view bytes) {
  bytes = bytes.substr(0, bytes.find_last_not_of(" \t\r\n\x1a") + 1);
  return is_first_of_section('T', bytes.substr(bytes.rfind('\n') + 1));
}

bool looks_like_brep(std::string_view bytes) {
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  return bytes.starts_with("DBRep_DrawableShape") || bytes.starts_with("CASCADE Topology");
}

// Recognized by a part of its name in STEP and IGES.
LengthUnit unit_named(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  struct Known {
    const char* part;
    LengthUnit unit;
  };
  static const Known known[] = {
      {"milli", {"millimetre", 1}},    {"centi", {"centimetre", 10}}, {"micro", {"micrometre", 1e-3}},
      {"kilo", {"kilometre", 1e6}},    {"metre", {"metre", 1000}},    {"meter", {"metre", 1000}},
      {"micro", {"micrometre", 1e-3}}, {"inch", {"inch", 25.4}},      {"foot", {"foot", 304.8}},
  };
  for (const Known& entry : known)
    if (name.find(entry.part) != std::string::npos) return entry.unit;
  static const Known short_names[] = {{"mm", {"millimetre", 1}}, {"cm", {"centimetre", 10}},
                                      {"m", {"metre", 1000}},    {"in", {"inch", 25.4}},
                                      {"ft", {"foot", 304.8}},   {"um", {"micrometre", 1e-3}}};
  for (const Known& entry : short_names)
    if (name == entry.part) return entry.unit;
  return {name, 0};
}

void set_unit(const std::string& name, CadModel& model) {
  model.unit = unit_named(name);
  if (model.unit.millimetres > 0) return;
  model.warnings.push_back(fmt::format("the unit of length, '{}', is not known; millimetres are written", name));
  model.unit = {};
}

Handle(TDocStd_Document) new_document() {
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  XCAFDoc_DocumentTool::Set(document->Main(), Standard_False);
  XCAFDoc_ShapeTool::SetAutoNaming(Standard_False);
  return document;
}

TopoDS_Shape whole_of(const Handle(TDocStd_Document) & document) {
  TDF_LabelSequence labels;
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(labels);
  BRep_Builder builder;
  TopoDS_Compound whole;
  builder.MakeCompound(whole);
  for (Standard_Integer i = 1; i <= labels.Length(); ++i)
    builder.Add(whole, XCAFDoc_ShapeTool::GetShape(labels.Value(i)));
  return whole;
}

// As the other readers, gives all shapes of the file to `whole`, also those that are in no body. `path` is where other
// files with parts are sought beside, empty for the current folder.
CadModel read_step(const std::string& bytes, const std::string& name, const std::string& path, TopoDS_Shape& whole) {
  check_end_of_step(bytes, name);
  STEPCAFControl_Controller::Init();
  STEPCAFControl_Reader reader;
  reader.SetColorMode(Standard_True);
  reader.SetNameMode(Standard_True);
  reader.SetLayerMode(Standard_True);
  std::istringstream stream(bytes);
  // OpenCASCADE seeks other files beside a whole path alone.
  const std::string place = path.empty() ? path : std::filesystem::absolute(path).string();
  check_was_read(reader.ChangeReader().ReadStream(place.c_str(), stream), name);
  CadModel model;
  if (std::string faults = faulty_entities(reader.Reader().WS()); !faults.empty())
    model.warnings.push_back(std::move(faults));
  check_referenced_files(reader.Reader().WS(), name, model.warnings);
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  if (lengths.IsEmpty())
    model.names_unit = false;
  else
    set_unit(lengths.First().ToCString(), model);
  Handle(TDocStd_Document) document = new_document();
  if (!reader.Transfer(document))
    throw DataError::at(name, "expected shapes in a STEP file, found none that OpenCASCADE can make");
  std::vector<std::string> lost;
  const auto add_contents = [&](const Handle(XSControl_WorkSession) & session, const std::string& prefix) {
    add_entity_names(session, model.names);
    if (const std::string solids = lost_solids(session); !solids.empty()) lost.push_back(prefix + solids);
  };
  add_contents(reader.Reader().WS(), "");
  for (NCollection_DataMap<TCollection_AsciiString, Handle(STEPCAFControl_ExternFile)>::Iterator file(
           reader.ExternFiles());
       file.More(); file.Next())
    add_contents(file.Value()->GetWS(), std::string(file.Key().ToCString()) + ": ");
  add_document_names(document, model.names);
  add_bodies(document, model);
  // Where there is no other body, their shells may still be sewn.
  if (!model.bodies.empty()) model.warnings.insert(model.warnings.end(), lost.begin(), lost.end());
  whole = whole_of(document);
  if (!TopExp_Explorer(whole, TopAbs_FACE).More() && bytes.find("TESSELLATED_SOLID") != std::string::npos)
    throw DataError::at(
        name,
        "expected bodies with exact faces, found some of triangles (TESSELLATED_SOLID), which OpenCASCADE "
        "does not read; STL keeps triangles, too");
  return model;
}

// OpenCASCADE reads IGES from a file only.
class NamedFile {
 public:
  NamedFile(const std::string& path, const std::string& bytes) : path_(path) {
    if (!path.empty()) return;
    const char* folder = std::getenv("TMPDIR");
    path_ = fmt::format("{}/tessellate-XXXXXX", folder == nullptr || *folder == '\0' ? "/tmp" : folder);
    const int descriptor = mkstemp(path_.data());
    if (descriptor < 0) throw DataError::at(path_, "cannot write a temporary file");
    made_ = true;
    std::size_t written = 0;
    while (written < bytes.size()) {
      const ssize_t count = ::write(descriptor, bytes.data() + written, bytes.size() - written);
      if (count <= 0) break;
      written += static_cast<std::size_t>(count);
    }
    ::close(descriptor);
    if (written < bytes.size()) throw DataError::at(path_, "cannot write a temporary file");
  }
  ~NamedFile() {
    if (made_) unlink(path_.c_str());
  }
  NamedFile(const NamedFile&) = delete;
  NamedFile& operator=(const NamedFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  bool made_ = false;
};

// OpenCASCADE crashes at a subfigure without a name.
bool names_are_whole(const Handle(IGESData_IGESModel) & model) {
  for (Standard_Integer i = 1; i <= model->NbEntities(); ++i) {
    const auto subfigure = Handle(IGESBasic_SubfigureDef)::DownCast(model->Entity(i));
    if (!subfigure.IsNull() && subfigure->Name().IsNull()) return false;
  }
  return true;
}

CadModel read_iges(const std::string& bytes, const std::string& name, const std::string& path, TopoDS_Shape& whole) {
  if (!ends_as_iges(bytes))
    throw DataError::at(name, "expected a line of section T at the end of an IGES file, found none: it is cut off");
  const NamedFile file(path, bytes);
  IGESCAFControl_Reader reader;
  reader.SetColorMode(Standard_True);
  reader.SetLayerMode(Standard_True);
  if (reader.ReadFile(file.path().c_str()) != IFSelect_RetDone)
    throw DataError::at(name, "expected an IGES file, found one that OpenCASCADE cannot read");
  CadModel model;
  const bool has_names = names_are_whole(reader.IGESModel());
  reader.SetNameMode(has_names);
  if (!has_names) model.warnings.push_back("a subfigure has no name; OpenCASCADE then reads no names at all");
  const Handle(TCollection_HAsciiString) unit = reader.IGESModel()->GlobalSection().UnitName();
  if (unit.IsNull())
    model.names_unit = false;
  else
    set_unit(unit->ToCString(), model);
  Handle(TDocStd_Document) document = new_document();
  if (!reader.Transfer(document))
    throw DataError::at(name, "expected shapes in an IGES file, found none that OpenCASCADE can make");
  add_document_names(document, model.names);
  add_bodies(document, model);
  whole = whole_of(document);
  return model;
}

CadModel read_brep(const std::string& bytes, const std::string& name, TopoDS_Shape& whole) {
  std::istringstream stream(bytes);
  BRepTools::Read(whole, stream, BRep_Builder());
  if (whole.IsNull())
    throw DataError::at(name, "expected a shape in BREP, found one that OpenCASCADE cannot read: it is cut off");
  CadModel model;
  model.names_unit = false;
  for (TopExp_Explorer solid(whole, TopAbs_SOLID); solid.More(); solid.Next())
    model.bodies.push_back({solid.Current(), {}});
  return model;
}

}  // namespace

std::string message_of(const Standard_Failure& failure) {
  const std::string_view message = failure.GetMessageString();
  return std::string(message.empty() ? failure.DynamicType()->Name() : message);
}

namespace {

CadModel read_by_content(formats::Input& input, bool needs_bodies, TopoDS_Shape& whole) {
  const std::string bytes = input.read_all();
  const std::string& name = input.name();
  if (bytes.empty()) throw DataError::at(name, "{}, found nothing: it is empty", expected);
  const std::string_view text = formats::without_byte_order_mark(bytes);
  if (text.substr(0, 4096).find(step_begin) != std::string_view::npos)
    return read_step(bytes, name, input.path(), whole);
  if (looks_like_brep(text)) return read_brep(bytes, name, whole);
  if (looks_like_iges(text)) return read_iges(bytes, name, input.is_decoded() ? "" : input.path(), whole);
  if (looks_like_freecad(bytes)) return read_freecad(bytes, name, input.path(), needs_bodies, whole);
  const auto kind = formats::kind_of_foreign_file(text);
  throw DataError::at(name, "{}, found {}{}", expected,
                      kind ? kind->name : formats::quote_found(formats::TextScanner(text, name).peek_word()),
                      kind ? kind->remedy : "");
}

}  // namespace

CadModel read_cad(formats::Input& input, bool needs_bodies) {
  try {
    TopoDS_Shape whole;
    CadModel model = read_by_content(input, needs_bodies, whole);
    if (model.bodies.empty() && needs_bodies)
      make_bodies(whole, input.name(), model);
    else
      find_sheets(whole, model);
    for (std::size_t i = 0; i < model.bodies.size(); ++i) model.bodies[i].number = i + 1;
    return model;
  } catch (const Standard_Failure& failure) {
    throw DataError::at(input.name(), "OpenCASCADE cannot read it: {}", message_of(failure));
  }
}

}  // namespace hexpipe::tessellate
