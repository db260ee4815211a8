#include "tools/tessellate/join_bodies.hpp"

#include <fmt/format.h>

#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "tools/tessellate/cad_model.hpp"

namespace hexpipe::tessellate {
namespace {

// Volumes that differ by less than this share of them are equal.
constexpr double rounding = 1e-9;

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return std::abs(properties.Mass());
}

// By number, for several may have one name.
std::string name_of(const CadModel& model, std::size_t body) {
  const auto& [solid, name, number] = model.bodies[body];
  return name.empty() ? fmt::format("body {}", number) : fmt::format("body {} ('{}')", number, name);
}

void set_up(BRepAlgoAPI_BuilderAlgo& algorithm, const TopTools_ListOfShape& arguments) {
  algorithm.SetArguments(arguments);
  algorithm.SetNonDestructive(Standard_True);
  algorithm.SetRunParallel(Standard_False);
}

// One that is inside out would be the space around it.
void turn_outward(CadModel& model) {
  for (CadBody& body : model.bodies) {
    if (body.solid.ShapeType() != TopAbs_SOLID) continue;
    TopoDS_Solid solid = TopoDS::Solid(body.solid);
    BRepLib::OrientClosedSolid(solid);
    body.solid = solid;
  }
}

// All bodies and sheets.
void fuse_all(const CadModel& model, const std::string& source, BRepAlgoAPI_BuilderAlgo& fuse) {
  TopTools_ListOfShape arguments;
  for (const CadBody& body : model.bodies) arguments.Append(body.solid);
  for (const TopoDS_Shape& sheet : model.sheets) arguments.Append(sheet);
  set_up(fuse, arguments);
  fuse.Build();
  if (fuse.HasErrors())
    throw DataError::at(source, "OpenCASCADE cannot join its bodies and faces (--join, --overlaps, --keep-baffles)");
}

// The shapes that the general fuse has made of a shape.
TopTools_ListOfShape parts_of(const TopoDS_Shape& shape, BRepAlgoAPI_BuilderAlgo& fuse) {
  TopTools_ListOfShape parts = fuse.Modified(shape);
  if (parts.IsEmpty() && !fuse.IsDeleted(shape)) parts.Append(shape);
  return parts;
}

// The names of a shape's parts, for what a change made of them.
void carry(const TopoDS_Shape& shape, BRepAlgoAPI_BuilderAlgo& change, ShapeNames& names) {
  carry_names(shape, names, [&](const TopoDS_Shape& part, const auto& set) {
    for (const TopoDS_Shape& made : change.Modified(part)) set(made);
  });
}

// Two bodies, the first of them first, and the volume that both have.
struct Overlap {
  std::size_t one, other;
  double volume, share;  // of the smaller body
};

std::vector<Overlap> find_overlaps(const CadModel& model, BRepAlgoAPI_BuilderAlgo& fuse) {
  TopTools_IndexedMapOfShape parts;
  std::vector<std::vector<std::size_t>> owners;  // by part
  for (std::size_t body = 0; body < model.bodies.size(); ++body)
    for (const TopoDS_Shape& part : parts_of(model.bodies[body].solid, fuse)) {
      const auto number = static_cast<std::size_t>(parts.Add(part));
      owners.resize(std::max(owners.size(), number));
      owners[number - 1].push_back(body);
    }
  std::map<std::pair<std::size_t, std::size_t>, double> volumes;
  for (std::size_t part = 0; part < owners.size(); ++part) {
    const std::vector<std::size_t>& of = owners[part];
    if (of.size() < 2) continue;
    const double volume = volume_of(parts(static_cast<int>(part) + 1));
    for (std::size_t i = 0; i < of.size(); ++i)
      for (std::size_t j = i + 1; j < of.size(); ++j) volumes[{of[i], of[j]}] += volume;
  }
  std::vector<Overlap> overlaps;
  for (const auto& [bodies, volume] : volumes) {
    const auto [one, other] = bodies;
    const double smaller = std::min(volume_of(model.bodies[one].solid), volume_of(model.bodies[other].solid));
    overlaps.push_back({one, other, volume, volume / smaller});
  }
  return overlaps;
}

// The two that have most in common, by how much, and how many more there are.
std::string text_about(const std::vector<Overlap>& overlaps, const CadModel& model) {
  const Overlap& most = *std::ranges::max_element(overlaps, {}, &Overlap::share);
  const std::size_t more = overlaps.size() - 1;
  return fmt::format("{} and {} by {:.3g} % of the smaller one{}", name_of(model, most.one), name_of(model, most.other),
                     100 * most.share,
                     more == 0 ? "" : fmt::format(", and {} more pair{}", more, more == 1 ? "" : "s"));
}

const char* winner_by(Overlaps rule) {
  return rule == Overlaps::first ? "first" : rule == Overlaps::last ? "last" : "smaller";
}

// Cuts what is another one's off one of the two bodies of each overlap.
void give_away(const std::vector<Overlap>& overlaps, Overlaps rule, const std::string& source, CadModel& model) {
  std::vector<double> volumes;
  for (const CadBody& body : model.bodies) volumes.push_back(rule == Overlaps::small ? volume_of(body.solid) : 0);
  std::vector<TopTools_ListOfShape> cut_by(model.bodies.size());
  for (const auto& [one, other, volume, share] : overlaps) {
    const bool is_others = rule == Overlaps::last || volumes[other] < (1 - rounding) * volumes[one];
    const auto [winner, loser] = is_others ? std::pair(other, one) : std::pair(one, other);
    cut_by[loser].Append(model.bodies[winner].solid);
  }
  std::vector<CadBody> left;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    CadBody& body = model.bodies[i];
    if (cut_by[i].IsEmpty()) {
      left.push_back(body);
      continue;
    }
    TopTools_ListOfShape whole;
    whole.Append(body.solid);
    BRepAlgoAPI_Cut cut;
    set_up(cut, whole);
    cut.SetTools(cut_by[i]);
    cut.Build();
    if (cut.HasErrors())
      throw DataError::at(source, "OpenCASCADE cannot cut off {} what is another body's (--overlaps)",
                          name_of(model, i));
    carry(body.solid, cut, model.names);
    for (const TopoDS_Shape& winner : cut_by[i]) carry(winner, cut, model.names);
    const std::size_t before = left.size();
    for (TopExp_Explorer solid(cut.Shape(), TopAbs_SOLID); solid.More(); solid.Next())
      left.push_back({solid.Current(), body.name, body.number});
    if (left.size() == before)
      model.warnings.push_back(fmt::format("{} lies in others, and is left out (--overlaps)", name_of(model, i)));
  }
  model.bodies = std::move(left);
}

// Tells how many of the sheets' faces lie in no body, or on the boundary of one.
void tell_lost_sheets(CadModel& model, BRepAlgoAPI_BuilderAlgo& fuse) {
  TopTools_MapOfShape inside;
  for (const CadBody& body : model.bodies)
    for (TopExp_Explorer face(body.solid, TopAbs_FACE); face.More(); face.Next())
      if (face.Current().Orientation() == TopAbs_INTERNAL) inside.Add(face.Current());
  int lost = 0;
  for (const TopoDS_Shape& sheet : model.sheets)
    for (const TopoDS_Shape& part : parts_of(sheet, fuse)) lost += inside.Contains(part) ? 0 : 1;
  if (lost > 0)
    model.warnings.push_back(fmt::format("{} outside of all bodies, or on their boundary, {} no baffle{} and left out",
                                         counted(lost, "face"), lost == 1 ? "is" : "are", lost == 1 ? "" : "s"));
}

// The bodies become those that the general fuse has made of them.
void take_joined(CadModel& model, BRepAlgoAPI_BuilderAlgo& fuse) {
  for (const TopoDS_Shape& sheet : model.sheets) carry(sheet, fuse, model.names);
  std::vector<CadBody> joined;
  for (const CadBody& body : model.bodies) {
    carry(body.solid, fuse, model.names);
    for (const TopoDS_Shape& part : parts_of(body.solid, fuse)) joined.push_back({part, body.name, body.number});
  }
  model.bodies = std::move(joined);
  tell_lost_sheets(model, fuse);
}

}  // namespace

std::size_t join_bodies(const std::string& source, Overlaps rule, CadModel& model) {
  const auto is_single = [&] { return model.bodies.size() + model.sheets.size() < 2; };
  if (is_single()) return 0;
  turn_outward(model);
  BRepAlgoAPI_BuilderAlgo fuse;
  fuse_all(model, source, fuse);
  const std::vector<Overlap> overlaps = find_overlaps(model, fuse);
  if (overlaps.empty()) {
    take_joined(model, fuse);
    return 0;
  }
  const std::string text = text_about(overlaps, model);
  if (rule == Overlaps::refuse)
    throw DataError::at(source,
                        "expected bodies that touch at most, found some that overlap: {} (--overlaps says whose that "
                        "is, --body takes one alone)",
                        text);
  model.warnings.push_back(
      fmt::format("bodies overlapped: {}; that is the {} one's now (--overlaps)", text, winner_by(rule)));
  give_away(overlaps, rule, source, model);
  if (is_single()) return overlaps.size();
  BRepAlgoAPI_BuilderAlgo again;
  fuse_all(model, source, again);
  if (const std::vector<Overlap> left = find_overlaps(model, again); !left.empty())
    throw DataError::at(source, "OpenCASCADE cannot cut bodies apart that overlap: {} (--overlaps)",
                        text_about(left, model));
  take_joined(model, again);
  return overlaps.size();
}

}  // namespace hexpipe::tessellate
