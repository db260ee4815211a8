#include <fmt/format.h>

#include <string>

#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/exact_shape.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/fitcad/fitcad.hpp"

using namespace hexpipe;
using namespace hexpipe::fitcad;

namespace {

void report(RunContext& context, const FitcadResult& result) {
  context.statistics.update(to_json(result));
  context.note(
      fmt::format("{} vertices of the boundary, {} of them on curves and {} on corners of the CAD, are within "
                  "{:.3g} of their places; they were within {:.3g}",
                  result.boundary, result.on_curves, result.on_corners, result.after.vertices, result.before.vertices));
  context.note(fmt::format("the boundary is within {:.3g} of the CAD, and the CAD within {:.3g} of the boundary",
                           result.after.to_cad, result.after.from_cad));
  if (result.counts.poorer > 0)
    context.note(
        fmt::format("{} cells other than hexes became poorer than 0.02, so that vertices beside them are on the CAD",
                    result.counts.poorer));
  if (result.counts.held > 0)
    context.warn(
        fmt::format("{} of {} vertices of the boundary stay up to {:.3g} off the CAD, because cells would "
                    "become too poor",
                    result.counts.held, result.boundary, result.after.vertices));
  if (result.strays > 0)
    context.warn(fmt::format("{} of {} vertices of the boundary are too far from the CAD, and stay where they are",
                             result.strays, result.boundary));
}

// The CAD's faces in a bundle of tessellate.
pipeline::ExactShape read_shape(const std::string& path) {
  formats::Input input = formats::Input::open(path);
  pipeline::ExactShape shape;
  if (!pipeline::looks_like_bundle(input))
    throw DataError::at(path, "expected a bundle, as tessellate writes it, found another file");
  pipeline::BundleReader reader(input);
  while (reader.next()) pipeline::read_shape_member(reader, shape, nullptr);
  return shape;
}

void run(RunContext& context, const FitcadOptions& options, const std::string& cad) {
  pipeline::Stage stage(context);
  pipeline::StageData data = stage.read({.needs = {Role::result}, .shape = cad.empty()});
  const std::string source = cad.empty() ? stage.source_of(Role::result) : cad;
  if (!cad.empty()) data.shape = read_shape(cad);
  if (!data.shape || data.shape->empty())
    throw DataError::at(source,
                        "expected the CAD's faces beside the result, found none; tessellate puts them into its "
                        "bundle");
  const CadShape shape(*data.shape, source);
  const FitcadResult result = fit_to_cad(*data.result, shape, options);
  report(context, result);
  nlohmann::ordered_json details = to_json(result);
  details.erase("cells");
  stage.write(pipeline::ResultProduct{.mesh = *std::move(data.result)}, details);
}

}  // namespace

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "fitcad",
      .summary = "Move the boundary of a result onto the faces and curves of the CAD that it was made from.",
      .example = "tessellate part.step | tetmesh | findhex | buildgraph | initsol | assemble | fitcad -o part.vtu",
      .reads = {Role::result},
      .product = Role::result,
  };
  FitcadOptions options;
  std::string cad;
  const auto declare = [&](CLI::App& app) {
    app.add_option("--reach", options.reach,
                   "How far a vertex may be from its place on the CAD, in lengths of the edges there")
        ->check(number_between(0, 1));
    outside_history(app.add_option("--cad", cad,
                                   "The bundle of tessellate that has the CAD's faces, for a result without them: that "
                                   "of a file, or of parts that were merged"))
        ->type_name("FILE");
  };
  return tool_main(argc, argv, info, declare, [&](RunContext& context) { run(context, options, cad); });
}
