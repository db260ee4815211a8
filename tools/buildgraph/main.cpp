#include <map>

#include "common/run/option_checks.hpp"
#include "common/run/phases.hpp"
#include "common/run/tool_main.hpp"
#include "formats/stage.hpp"
#include "tools/buildgraph/buildgraph.hpp"
#include "tools/buildgraph/report.hpp"

using namespace hexpipe;

int main(int argc, char** argv) {
  const std::map<std::string, WeightKind> weights{{"quality", WeightKind::quality},
                                                  {"volume", WeightKind::volume},
                                                  {"count", WeightKind::count},
                                                  {"quality*volume", WeightKind::quality_volume}};
  const ToolInfo info{
      .name = "buildgraph",
      .summary = "Compare candidates: the graph of those that cannot both be chosen.",
      .example = "buildgraph engine.cand --weight volume -o engine.graph",
      .reads = {Role::candidates},
      .product = Role::graph,
  };
  BuildgraphOptions options;
  std::string weight = "quality", part = "1/1";
  const auto declare = [&](CLI::App& app) {
    app.add_option("--weight", weight, "What a candidate is worth: quality, volume, count (1 each) or quality*volume")
        ->check(CLI::IsMember(weights));
    app.add_option("--weight-scale", options.weight_scale, "Weights are rounded after multiplication with this")
        ->check(number_between(1e-100, 1e100));
    app.add_option("--part", part,
                   "i/k: only conflicts whose higher candidate is in part i of k; see Makefile.examples");
  };
  const auto run = [&](RunContext& context) {
    options.weight = weights.at(weight);
    options.part = parse_part(part);
    Phases phases;
    Stage stage(context);
    StageData data = stage.read({Role::candidates});
    phases.end("read");
    const ConflictGraph graph =
        buildgraph(std::move(*data.candidates), options, stage.source_of(Role::candidates).c_str());
    phases.end("build");
    const GraphSummary summary = summarize(graph);
    for (const auto& warning : warnings_about(summary)) context.warn(warning);
    context.note(summary_line(summary));
    context.statistics.update(to_json(summary));
    stage.write(graph, {{"vertices", summary.vertices}, {"edges", summary.edges}});
    phases.end("write");
    context.statistics.update(phases.seconds());
  };
  return tool_main(argc, argv, info, declare, run);
}
