#include <fmt/format.h>

#include "common/run/option_checks.hpp"
#include "common/run/phases.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/mesh-part/mesh_part.hpp"
#include "tools/mesh-part/options.hpp"
#include "tools/mesh-part/part_files.hpp"

using namespace hexpipe;
using namespace hexpipe::mesh_part;

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "mesh-part",
      .summary = "Split a mesh into parts, each a bundle that findhex and buildgraph work on alone.",
      .example = "mesh-part engine.msh --parts 16 -o engine.parts && findhex engine.parts/part-0003.tar -o 3.tar",
      .reads = {Role::mesh},
      .product = std::nullopt,
      .random = true,
  };
  MeshPartOptions options;
  const auto declare = [&](CLI::App& app) {
    app.add_option("--parts", options.parts, "How many parts of about as many tets")
        ->required()
        ->check(whole_number_between(1, most_parts));
    outside_history(
        app.add_option("-o,--output", options.directory, "The directory for part-0000.tar and so on; it is made"))
        ->required()
        ->type_name("DIR");
    outside_history(app.add_flag("--compress", options.compress, "Compress the bundles with zstd"))
        ->group(group::output);
  };
  const auto run = [&](RunContext& context) {
    options.seed = context.common.seed;
    Phases phases;
    pipeline::Stage stage(context);
    pipeline::StageData data = stage.read({.needs = {Role::mesh}, .dislocations = true, .surface_members = true});
    const std::string source = stage.source_of(Role::mesh);
    phases.end("read");
    data.history.push_back(pipeline::history_entry_of(context));
    PartFiles files(options.directory, options.parts, options.compress);
    const SplitCounts counts =
        split(std::move(*data.mesh), options.parts, options.seed, source.c_str(), [&](const PartOfMesh& part) {
          files.write(part, {data.history, data.names, data.surface_members, data.dislocations});
        });
    files.commit();
    phases.end("split");
    context.note(summary(counts));
    context.statistics.update(to_json(counts));
    context.statistics.update(phases.seconds());
  };
  return tool_main(argc, argv, info, declare, run);
}
