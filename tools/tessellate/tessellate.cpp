#include "tools/tessellate/tessellate.hpp"

#include <fmt/format.h>

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Standard_Failure.hxx>

#include "common/run/error.hpp"
#include "common/run/muted_cout.hpp"
#include "common/run/progress.hpp"
#include "tools/tessellate/cad_model.hpp"
#include "tools/tessellate/crash_message.hpp"
#include "tools/tessellate/triangulate.hpp"

namespace hexpipe::tessellate {
namespace {

LengthUnit wanted_unit(const CadModel& model, const TessellateOptions& options) {
  if (options.unit == "m") return {"metre", 1000};
  if (options.unit == "mm") return {"millimetre", 1};
  return model.unit;
}

void leave_out_sheets(CadModel& model) {
  const std::size_t count = model.sheets.size();
  if (count > 0)
    model.warnings.push_back(fmt::format("{} that {} to no body {} left out (see --keep-baffles)",
                                         count == 1 ? "a face" : fmt::format("{} faces", count),
                                         count == 1 ? "belongs" : "belong", count == 1 ? "is" : "are"));
  model.sheets.clear();
}

std::string text_about(const MadeAnew& made_anew, double deviation) {
  const bool is_one = made_anew.crossings == 1;
  const std::string pairs = fmt::format("{} pair{} of triangles", made_anew.crossings, is_one ? "" : "s");
  if (made_anew.helped)
    return fmt::format("{} crossed each other; none do since triangles were made anew, within {:.4g} of the faces",
                       pairs, deviation);
  if (made_anew.collapsed > 0)
    return fmt::format("{} crossed each other; none do since {} there, of at most {:.4g}, became points", pairs,
                       made_anew.collapsed == 1 ? "a short edge" : fmt::format("{} short edges", made_anew.collapsed),
                       deviation);
  return fmt::format("{} cross{} each other, and so do finer and coarser ones", pairs, is_one ? "es" : "");
}

}  // namespace

TessellateResult tessellate(formats::Input& input, const TessellateOptions& options) {
  const CrashMessage crash_message(input.name());
  const MutedCout muted;
  Message::DefaultMessenger()->ChangePrinters().Clear();
  std::optional<Step> step(std::in_place, "reading the model", 0, 0.4);
  CadModel model = read_cad(input, !options.open);
  const LengthUnit unit = wanted_unit(model, options);
  TessellateResult result;
  try {
    step.emplace("checking bodies", 0.4, 0.6);
    if (!options.bodies.empty()) keep_bodies(options.bodies, input.name(), model);
    heal_bodies(model);
    if (options.open) {
      if (!options.bodies.empty()) model.sheets.clear();
      put_together(input.name(), model);
    } else if (!options.keep_baffles) {
      leave_out_sheets(model);
    }
    if (options.join || options.keep_baffles) result.overlaps = join_bodies(input.name(), options.overlaps, model);
    TriangulationOptions triangulation{
        .angle = options.angle, .keep_baffles = options.keep_baffles, .open = options.open};
    if (options.deviation) triangulation.deviation = *options.deviation * unit.millimetres;
    step.emplace("making triangles", 0.6);
    Triangulation made = triangulate(model, triangulation, input.name());
    result.surface = std::move(made.surface);
    result.shape = std::move(made.shape);
    result.shape.unit = unit.millimetres;
    result.faces = made.faces;
    result.curves = made.curves;
    result.deviation = made.deviation / unit.millimetres;
    result.crossings = made.made_anew.crossings;
    result.collapsed_edges = made.made_anew.collapsed;
    result.gap_triangles = made.gap_triangles;
    result.joined_nodes = made.joined_nodes;
    if (made.empty_faces > 0)
      model.warnings.push_back(fmt::format("OpenCASCADE cannot make triangles of {}, which {} left out",
                                           made.empty_faces == 1 ? "a face" : fmt::format("{} faces", made.empty_faces),
                                           made.empty_faces == 1 ? "is" : "are"));
    if (result.crossings > 0) model.warnings.push_back(text_about(made.made_anew, result.deviation));
  } catch (const Standard_Failure& failure) {
    throw DataError::at(input.name(), "OpenCASCADE failed: {}", message_of(failure));
  }
  for (Vec3& p : result.surface.points) p = {p.x / unit.millimetres, p.y / unit.millimetres, p.z / unit.millimetres};
  result.bodies = options.open ? 0 : model.bodies.size();
  result.warnings = std::move(model.warnings);
  if (model.names_unit || options.unit) result.unit = unit.name;
  if (!options.unit && unit.name != "millimetre")
    result.warnings.push_back(fmt::format("its unit is the {}, and so is that of all lengths (see --unit)", unit.name));
  formats::check_extent(result.surface);
  return result;
}

nlohmann::ordered_json to_json(const TessellateResult& result) {
  nlohmann::ordered_json json{{"unit", nullptr},
                              {"deviation", result.deviation},
                              {"bodies", result.bodies},
                              {"faces", result.faces},
                              {"curves", result.curves},
                              {"points", result.surface.points.size()},
                              {"triangles", result.surface.triangles.size()},
                              {"overlaps", result.overlaps},
                              {"crossings", result.crossings},
                              {"collapsed_edges", result.collapsed_edges},
                              {"gap_triangles", result.gap_triangles},
                              {"joined_nodes", result.joined_nodes},
                              {"names", result.surface.names.surfaces.size()}};
  if (!result.unit.empty()) json["unit"] = result.unit;
  return json;
}

}  // namespace hexpipe::tessellate
