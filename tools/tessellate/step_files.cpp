#include "tools/tessellate/step_files.hpp"

#include <fmt/format.h>

#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <OSD_Path.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <STEPControl_Reader.hxx>
#include <StepData_StepModel.hxx>
#include <StepShape_ManifoldSolidBrep.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <system_error>

#include "common/run/error.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/text_scanner.hpp"
#include "tools/tessellate/occt_names.hpp"

namespace hexpipe::tessellate {
namespace {

constexpr std::string_view step_end = "END-ISO-10303-21";
// What OpenCASCADE takes references for; others it leaves out.
constexpr std::array<std::string_view, 2> formats_read{"STEP AP203", "STEP AP214"};  // in capitals or not

bool is_named_as_step(std::string_view file) {
  constexpr std::array<std::string_view, 3> endings{".stp", ".step", ".p21"};
  return std::ranges::any_of(endings, [&](std::string_view ending) {
    return file.size() >= ending.size() &&
           formats::equal_ignoring_case(file.substr(file.size() - ending.size()), ending);
  });
}

// As OpenCASCADE finds it: from the folder of the file that was read.
std::string place_of(const std::string& file, const Handle(XSControl_WorkSession) & session) {
  OSD_Path folder(session->LoadedFile());
  folder.SetName("");
  folder.SetExtension("");
  TCollection_AsciiString path;
  folder.SystemName(path);
  const TCollection_AsciiString place = OSD_Path::AbsolutePath(path, file.c_str());
  return place.IsEmpty() ? file : place.ToCString();
}

bool is_piped(const Handle(XSControl_WorkSession) & session) {
  return *session->LoadedFile() == '\0';
}

class FileCheck {
 public:
  explicit FileCheck(std::vector<std::string>& warnings) : warnings_(warnings) {}

  void check_references_of(const Handle(XSControl_WorkSession) & session, const std::string& name,
                           const std::string& place) {
    open_.insert(place);
    STEPConstruct_ExternRefs references(session);
    references.LoadExternRefs();
    for (Standard_Integer i = 1; i <= references.NbExternRefs(); ++i) {
      const Standard_CString file = references.FileName(i);
      if (file == nullptr || *file == '\0') continue;
      const Handle(TCollection_HAsciiString) format = references.Format(i);
      check(file, format.IsNull() ? std::string() : format->ToCString(), name, session);
    }
    open_.erase(place);
  }

 private:
  void check(const std::string& file, const std::string& format, const std::string& name,
             const Handle(XSControl_WorkSession) & session) {
    // Drawings and names in the program's own data base.
    if (!is_named_as_step(file)) return;
    const auto is_format = [&](std::string_view known) { return formats::equal_ignoring_case(known, format); };
    if (!format.empty() && std::ranges::none_of(formats_read, is_format))
      throw DataError::at(
          name, "OpenCASCADE reads no part of the format '{}' from another file, as '{}' is; it reads {} and {}",
          format, file, formats_read[0], formats_read[1]);
    const std::string place = std::filesystem::weakly_canonical(place_of(file, session)).string();
    if (open_.contains(place))
      throw DataError::at(name, "expected parts in other files, found that '{}' refers back to itself", file);
    if (!done_.insert(place).second) return;
    std::error_code error;
    if (!std::filesystem::exists(place, error))
      throw DataError::at(name, "expected its part '{}' beside it{}, found no such file", file,
                          is_piped(session) ? ", which is the current folder for standard input" : "");
    check_file(file, place);
  }

  void check_file(const std::string& file, const std::string& place) {
    check_end_of_step(formats::Input::open(place).read_all(), place);
    // As OpenCASCADE will read it: packed, for example, it is of no use.
    STEPControl_Reader reader;
    check_was_read(reader.ReadFile(place.c_str()), place);
    if (const std::string faults = faulty_entities(reader.WS()); !faults.empty())
      warnings_.push_back(fmt::format("{}: {}", file, faults));
    check_references_of(reader.WS(), place, place);
  }

  std::vector<std::string>& warnings_;
  std::set<std::string> open_;  // files on the way from the first one
  std::set<std::string> done_;
};

// Styles of drawings, and texts and dimensions of units that are left out, as by many programs.
bool is_harmless(std::string_view type, std::string_view fault) {
  const auto says = [&](std::string_view words) { return fault.find(words) != std::string_view::npos; };
  return type.starts_with("StepVisual_") || says("name) not a quoted String") || says("(description) absent") ||
         says("(dimensions) not an Entity");
}

}  // namespace

void check_end_of_step(std::string_view bytes, const std::string& name) {
  if (bytes.substr(bytes.size() - std::min<std::size_t>(bytes.size(), 4096)).rfind(step_end) == std::string_view::npos)
    throw DataError::at(name, "expected {}; at the end of a STEP file, found none: it is cut off", step_end);
}

void check_was_read(IFSelect_ReturnStatus status, const std::string& name) {
  if (status != IFSelect_RetDone)
    throw DataError::at(name, "expected a STEP file, found one that OpenCASCADE cannot read: its syntax is wrong");
}

std::string faulty_entities(const Handle(XSControl_WorkSession) & session) {
  const auto entities = Handle(StepData_StepModel)::DownCast(session->Model());
  std::size_t faulty = 0;
  std::string first;
  Interface_CheckIterator checks = session->ModelCheckList();
  for (checks.Start(); checks.More(); checks.Next()) {
    const Handle(Interface_Check) check = checks.Value();
    if (checks.Number() < 1 || check->NbFails() == 0) continue;
    const Handle(Standard_Transient) entity = entities->Value(checks.Number());
    Standard_Integer fail = 1;
    while (fail <= check->NbFails() && is_harmless(entity->DynamicType()->Name(), check->CFail(fail))) ++fail;
    if (fail > check->NbFails()) continue;
    if (++faulty == 1) first = fmt::format("#{}: {}", entities->IdentLabel(entity), check->CFail(fail));
  }
  if (faulty == 0) return {};
  return fmt::format("{} faulty, and may be taken for something else; the first is {}",
                     faulty == 1 ? "an entity is" : fmt::format("{} entities are", faulty), first);
}

std::string lost_solids(const Handle(XSControl_WorkSession) & session) {
  const auto entities = Handle(StepData_StepModel)::DownCast(session->Model());
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  std::size_t lost = 0;
  std::string first;
  for (Standard_Integer i = 1; i <= entities->NbEntities(); ++i) {
    const auto solid = Handle(StepShape_ManifoldSolidBrep)::DownCast(entities->Value(i));
    // What no product uses was never asked for.
    if (solid.IsNull() || !process->IsBound(solid)) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, solid);
    if (!shape.IsNull() && TopExp_Explorer(shape, TopAbs_SOLID).More()) continue;
    if (++lost == 1) first = fmt::format("#{} '{}'", entities->IdentLabel(solid), cad_name(solid->Name()->ToCString()));
  }
  if (lost == 0) return {};
  return fmt::format("{} no closed shell, and {} left out; the first is {}",
                     lost == 1 ? "a solid has" : fmt::format("{} solids have", lost), lost == 1 ? "is" : "are", first);
}

void check_referenced_files(const Handle(XSControl_WorkSession) & session, const std::string& name,
                            std::vector<std::string>& warnings) {
  const std::string place = is_piped(session) ? "" : std::filesystem::weakly_canonical(session->LoadedFile()).string();
  FileCheck(warnings).check_references_of(session, name, place);
}

}  // namespace hexpipe::tessellate
