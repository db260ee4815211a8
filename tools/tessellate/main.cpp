#include <fmt/format.h>
#include <unistd.h>

#include <map>
#include <optional>
#include <string>

#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/surface_file.hpp"
#include "formats/streams/output.hpp"
#include "tools/tessellate/tessellate.hpp"

using namespace hexpipe;

namespace {

using tessellate::Overlaps;
const std::map<std::string, Overlaps> rules{
    {"refuse", Overlaps::refuse}, {"first", Overlaps::first}, {"last", Overlaps::last}, {"small", Overlaps::small}};

formats::Input open_cad(const std::string& path) {
  if (path == "-" && isatty(STDIN_FILENO))
    throw UsageError("nothing to read: name a CAD file, or pipe one to standard input (see tessellate --help)");
  return formats::Input::open(path);
}

}  // namespace

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "tessellate",
      .summary = "Make triangles of a CAD file (STEP, IGES, BREP, FreeCAD), with its curves, bodies and names.",
      .example = "tessellate part.step | tetmesh --size 3 | findhex | buildgraph | initsol | assemble -o part.vtu",
      .reads = {},
      .product = std::nullopt,
  };
  tessellate::TessellateOptions options;
  std::string path = "-", output_path, overlaps;
  bool compress = false;
  const auto declare = [&](CLI::App& app) {
    app.add_option("cad", path, "A file in STEP, IGES, BREP or FreeCAD's FCStd; standard input if it is '-' or missing")
        ->type_name("FILE");
    app.add_option("--deviation", options.deviation,
                   "How far triangles may be from the CAD's surface [a hundredth of the size that tetmesh chooses; "
                   "with --open, of a twentieth of the diagonal]")
        ->check(number_between(1e-12, 1e12))
        ->type_name("LENGTH");
    app.add_option("--body", options.bodies,
                   "Take only the body of this name, or number in the file's order; repeatable [all]")
        ->allow_extra_args(false)
        ->type_name("NAME");
    begin_group(app, "Triangles");
    app.add_option("--angle", options.angle, "How far neighbours may turn on a smooth face, in degrees")
        ->check(number_between(1, 60));
    app.add_option("--unit", options.unit, "Write lengths in metres or millimetres [the file's own unit]")
        ->group(group::first)
        ->check(one_of({"m", "mm"}));
    CLI::Option* open =
        app.add_flag("--open", options.open,
                     "Write all faces, whether they enclose bodies or not, for wrap, which closes gaps between them");
    CLI::Option* join =
        app.add_flag("--join", options.join, "Let bodies that touch share their common faces, edges and corners");
    CLI::Option* of_overlaps =
        app.add_option(
               "--overlaps", overlaps,
               "Join bodies, and of two that overlap cut one: what both have is the first, last or smaller one's; or "
               "refuse them, as --join does")
            ->check(one_of(rules))
            ->type_name("RULE");
    CLI::Option* baffles = app.add_flag(
        "--keep-baffles", options.keep_baffles,
        "Keep faces inside that bound no body, joined to the faces that they meet, for tetmesh --keep-baffles");
    for (CLI::Option* of_bodies : {join, of_overlaps, baffles}) open->excludes(of_bodies);
    outside_history(
        app.add_option("-o,--output", output_path, "Write to a file, not to standard output: .tar, .obj, .stl or .msh"))
        ->group(group::first)
        ->type_name("FILE");
    outside_history(app.add_flag("--compress", compress, "Compress the bundle with zstd"))->group(group::output);
  };
  const auto run = [&](RunContext& context) {
    const std::string_view format = pipeline::surface_format_of(output_path);
    formats::Input input = open_cad(path);
    if (!overlaps.empty()) options.overlaps = rules.at(overlaps);
    options.join = options.join || !overlaps.empty();
    const tessellate::TessellateResult result = tessellate::tessellate(input, options);
    for (const std::string& warning : result.warnings) context.warn(input.name() + ": " + warning);
    formats::Output output(output_path);
    if (format.empty()) {
      nlohmann::ordered_json entry = pipeline::history_entry_of(context);
      entry.update(to_json(result));
      const bool is_compressed = compress || pipeline::ending_of(output_path) == pipeline::compressed_bundle_format;
      pipeline::write_surface_bundle(result.surface, {entry}, is_compressed, output, &result.shape);
    } else {
      for (const std::string& change : pipeline::write_surface(result.surface, format, output)) context.warn(change);
    }
    output.commit();
    context.note(fmt::format("{} bodies of {} faces, {} triangles within {:.4g} of them, lengths in {}", result.bodies,
                             result.faces, result.surface.triangles.size(), result.deviation,
                             result.unit.empty() ? "a unit that the file does not name" : "the unit " + result.unit));
    context.statistics.update(to_json(result));
  };
  return tool_main(argc, argv, info, declare, run);
}
