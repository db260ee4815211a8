#include "tools/tessellate/cad_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Pnt.hxx>
#include <string>
#include <utility>
#include <vector>

#include "common/run/error.hpp"

namespace hexpipe::tessellate {
namespace {

// Edges of loose faces within this share of the diagonal are one.
constexpr double sewing_tolerance = 1e-5;

int count_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum type) {
  TopTools_IndexedMapOfShape found;
  TopExp::MapShapes(shape, type, found);
  return found.Extent();
}

std::string counted_bodies(std::size_t count) {
  return count == 1 ? "1 body" : fmt::format("{} bodies", count);
}

// How many there are, and the first names.
std::string bodies_by_name(const CadModel& model) {
  std::vector<std::string> names;
  for (const CadBody& body : model.bodies)
    if (!body.name.empty() && std::ranges::find(names, body.name) == names.end()) names.push_back(body.name);
  std::string text = counted_bodies(model.bodies.size());
  if (names.empty()) return text + " without names";
  constexpr std::size_t most_names = 10;
  const bool are_all = names.size() <= most_names;
  if (!are_all) names.resize(most_names);
  return fmt::format("{}: '{}'{}", text, fmt::join(names, "', '"), are_all ? "" : " and others");
}

double diagonal_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

TopoDS_Solid solid_of(const TopoDS_Shell& shell) {
  BRep_Builder builder;
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  BRepLib::OrientClosedSolid(solid);
  return solid;
}

bool has_closed_shell(const TopoDS_Shape& shape) {
  for (TopExp_Explorer shell(shape, TopAbs_SHELL); shell.More(); shell.Next())
    if (BRep_Tool::IsClosed(shell.Current())) return true;
  return false;
}

// The faces beside all solids, or beside all shells, each once. Gmsh and others write BREP files that have the faces of
// solids again beside them.
std::vector<TopoDS_Shape> faces_beside(const TopoDS_Shape& shape, TopAbs_ShapeEnum wholes) {
  TopTools_IndexedMapOfShape known;
  for (TopExp_Explorer one(shape, wholes); one.More(); one.Next()) TopExp::MapShapes(one.Current(), TopAbs_FACE, known);
  std::vector<TopoDS_Shape> faces;
  for (TopExp_Explorer face(shape, TopAbs_FACE, wholes); face.More(); face.Next()) {
    if (known.Contains(face.Current())) continue;
    known.Add(face.Current());
    faces.push_back(face.Current());
  }
  return faces;
}

// Each face that stands alone gets a shell of its own. It may be closed, as the single face of a sphere or a torus is.
TopoDS_Shape with_shells(const TopoDS_Shape& shape) {
  BRep_Builder builder;
  TopoDS_Compound result;
  builder.MakeCompound(result);
  for (TopExp_Explorer shell(shape, TopAbs_SHELL); shell.More(); shell.Next()) builder.Add(result, shell.Current());
  for (const TopoDS_Shape& face : faces_beside(shape, TopAbs_SHELL)) {
    TopoDS_Shell shell;
    builder.MakeShell(shell);
    builder.Add(shell, face);
    builder.Add(result, shell);
  }
  return result;
}

// Adds a body for each closed shell; returns how many of several faces are open.
int add_closed_shells(const TopoDS_Shape& shape, CadModel& model) {
  int open = 0;
  for (TopExp_Explorer shell(shape, TopAbs_SHELL); shell.More(); shell.Next()) {
    if (BRep_Tool::IsClosed(shell.Current()))
      model.bodies.push_back({solid_of(TopoDS::Shell(shell.Current())), model.names.of(shell.Current())});
    else if (shell.Current().NbChildren() > 1)
      ++open;
  }
  return open;
}

// Adds the faces of open shells to the sheets.
void add_open_shells(const TopoDS_Shape& shape, CadModel& model) {
  for (TopExp_Explorer shell(shape, TopAbs_SHELL); shell.More(); shell.Next()) {
    if (BRep_Tool::IsClosed(shell.Current())) continue;
    for (TopExp_Explorer face(shell.Current(), TopAbs_FACE); face.More(); face.Next())
      model.sheets.push_back(face.Current());
  }
}

struct SewnFaces {
  TopoDS_Shape shape;
  std::string gap;  // how many edges have a single face, and where the first is; empty if none
};

SewnFaces sewn(const TopoDS_Shape& whole, ShapeNames& names) {
  BRepBuilderAPI_Sewing sewing(sewing_tolerance * diagonal_of(whole));
  for (TopExp_Explorer face(whole, TopAbs_FACE); face.More(); face.Next()) sewing.Add(face.Current());
  sewing.Perform();
  carry_names(whole, names, [&](const TopoDS_Shape& part, const auto& set) {
    if (sewing.IsModified(part)) set(sewing.Modified(part));
    if (part.ShapeType() == TopAbs_EDGE && sewing.IsModifiedSubShape(part)) set(sewing.ModifiedSubShape(part));
  });
  std::string gap;
  if (sewing.NbFreeEdges() > 0) {
    const TopoDS_Edge edge = sewing.FreeEdge(1);
    const gp_Pnt from = BRep_Tool::Pnt(TopExp::FirstVertex(edge)), to = BRep_Tool::Pnt(TopExp::LastVertex(edge));
    gap = fmt::format("; {} of a single face, the first from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})",
                      counted(sewing.NbFreeEdges(), "edge"), from.X(), from.Y(), from.Z(), to.X(), to.Y(), to.Z());
  }
  return {sewing.SewedShape(), std::move(gap)};
}

}  // namespace

std::string counted(int count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

TopoDS_Compound compound_of(const CadModel& model) {
  BRep_Builder builder;
  TopoDS_Compound whole;
  builder.MakeCompound(whole);
  for (const CadBody& body : model.bodies) builder.Add(whole, body.solid);
  return whole;
}

void make_bodies(const TopoDS_Shape& whole, const std::string& source, CadModel& model) {
  const int faces = count_of(whole, TopAbs_FACE);
  if (faces == 0)
    throw DataError::at(source, "expected bodies, found no solid and no face{}",
                        model.warnings.empty() ? "" : "; " + model.warnings.front());
  TopoDS_Shape shells = whole;
  const char* act = "shells that are closed are taken for bodies";
  std::string gap;
  if (!has_closed_shell(whole)) {
    SewnFaces made = sewn(whole, model.names);
    shells = made.shape;
    gap = std::move(made.gap);
    act = "its faces are sewn to bodies";
  }
  shells = with_shells(shells);
  const int open = add_closed_shells(shells, model);
  if (model.bodies.empty())
    throw DataError::at(source, "expected bodies, found no solid, and {} of {} that {} not closed{}{}",
                        open > 0 ? counted(open, "shell") : "sheets", counted(faces, "face"), open == 1 ? "is" : "are",
                        gap, way_out);
  model.warnings.push_back(fmt::format("there are no solids: {}, {}", act, counted_bodies(model.bodies.size())));
  add_open_shells(shells, model);
}

void find_sheets(const TopoDS_Shape& whole, CadModel& model) {
  for (TopExp_Explorer shell(whole, TopAbs_SHELL, TopAbs_SOLID); shell.More(); shell.Next())
    for (TopExp_Explorer face(shell.Current(), TopAbs_FACE); face.More(); face.Next())
      model.names.set(face.Current(), model.names.of(shell.Current()));
  for (const TopoDS_Shape& face : faces_beside(whole, TopAbs_SOLID)) model.sheets.push_back(face);
}

void keep_bodies(const std::vector<std::string>& wanted, const std::string& source, CadModel& model) {
  std::vector<bool> is_kept(model.bodies.size());
  for (const std::string& name : wanted) {
    const auto keep_where = [&](auto&& is_meant) {
      bool is_found = false;
      for (std::size_t i = 0; i < model.bodies.size(); ++i)
        if (is_meant(i)) is_found = is_kept[i] = true;
      return is_found;
    };
    if (!keep_where([&](std::size_t i) { return !name.empty() && model.bodies[i].name == name; }) &&
        !keep_where([&](std::size_t i) { return std::to_string(i + 1) == name; }))
      throw DataError::at(source, "expected a body of the name or number '{}' (--body), found {}", name,
                          bodies_by_name(model));
  }
  std::vector<CadBody> kept;
  for (std::size_t i = 0; i < model.bodies.size(); ++i)
    if (is_kept[i]) kept.push_back(std::move(model.bodies[i]));
  model.bodies = std::move(kept);
}

void put_together(const std::string& source, CadModel& model) {
  TopoDS_Compound whole = compound_of(model);
  for (const TopoDS_Shape& sheet : model.sheets) BRep_Builder().Add(whole, sheet);
  if (!TopExp_Explorer(whole, TopAbs_FACE).More()) throw DataError::at(source, "expected faces, found none");
  model.bodies = {{whole, {}}};
  model.sheets.clear();
}

void heal_bodies(CadModel& model) {
  std::size_t healed = 0, faulty = 0;
  for (CadBody& body : model.bodies) {
    if (BRepCheck_Analyzer(body.solid).IsValid()) continue;
    ShapeFix_Shape fix(body.solid);
    fix.Perform();
    const TopoDS_Shape fixed = fix.Shape();
    TopExp_Explorer solid(fixed, TopAbs_SOLID);
    if (!solid.More()) {
      ++faulty;
      continue;
    }
    const Handle(ShapeBuild_ReShape) context = fix.Context();
    carry_names(body.solid, model.names, [&](const TopoDS_Shape& part, const auto& set) { set(context->Apply(part)); });
    body.solid = solid.Current();
    BRepCheck_Analyzer(body.solid).IsValid() ? ++healed : ++faulty;
  }
  if (healed > 0) model.warnings.push_back(fmt::format("healed {}", counted_bodies(healed)));
  if (faulty > 0)
    model.warnings.push_back(fmt::format("{} did not hold together by OpenCASCADE's rules, and could not be healed",
                                         counted_bodies(faulty)));
}

}  // namespace hexpipe::tessellate
