#include <map>
#include <optional>
#include <utility>

#include "common/run/option_checks.hpp"
#include "common/run/phases.hpp"
#include "common/run/tool_main.hpp"
#include "formats/choice/cand.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/buildgraph/buildgraph.hpp"
#include "tools/buildgraph/report.hpp"

using namespace hexpipe;
using namespace hexpipe::buildgraph;

int main(int argc, char** argv) {
  const std::map<std::string, conflicts::WeightKind> weights{
      {"quality", conflicts::WeightKind::quality},
      {"volume", conflicts::WeightKind::volume},
      {"count", conflicts::WeightKind::count},
      {"quality*volume", conflicts::WeightKind::quality_volume},
      {"quality^0.3*volume", conflicts::WeightKind::mild_quality_volume}};
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
    app.add_option(
           "--weight", weight,
           "The weight of a candidate: quality, volume, count (1 each), quality*volume, or quality^0.3*volume as "
           "assemble's exchange weighs hexes, which suits --quad-reward")
        ->check(one_of(weights));
    app.add_option(
           "--quad-reward", options.quad_reward,
           "Rewards chosen candidates that share quads: each quad inside the mesh that only one chosen candidate has "
           "costs this, in weights of a candidate of quality 1. The quads become vertices of the graph; assemble then "
           "exchanges no hexes")
        ->type_name("SHARE")
        ->check(number_between(0, 10));
    begin_group(app, "Graph");
    app.add_option("--weight-scale", options.conflicts.weight_scale, "Weights are multiplied by this, then rounded")
        ->check(number_between(1e-100, 1e100));
    app.add_option("--part", part,
                   "i/k: only conflicts whose higher candidate is in share i of k; see Makefile.examples")
        ->group("In parts");
    app.add_flag("--reduce", options.reduce,
                 "Leave out candidates that no choice needs: another one has no more conflicts and weighs no less");
    outside_history(app.add_option("--reduced-candidates", options.reduced_candidates,
                                   "With --reduce: write the candidates that are left, vertex by vertex, to a .cand"))
        ->type_name("FILE");
    outside_history(
        app.add_option(
            "--neighbours", options.neighbours,
            "With a part of a mesh: bundles of the other parts' candidates; those beside this part are read"))
        ->group("In parts")
        ->type_name("FILE");
    app.add_flag(
           "--cover", options.cover,
           "Add an edge clique cover to the bundle: the cliques at tets, grown, and cliques for the edges that they "
           "miss")
        ->group(group::first);
  };
  const auto run = [&](RunContext& context) {
    options.conflicts.weight = weights.at(weight);
    options.conflicts.share = parse_share(part);
    Phases phases;
    pipeline::Stage stage(context);
    check(options, stage.writes_bundle());
    std::optional<formats::Output> reduced;
    if (!options.reduced_candidates.empty()) reduced.emplace(options.reduced_candidates);
    pipeline::StageRequest request{.needs = {Role::candidates}, .part = true};
    if (options.reduce || !options.neighbours.empty()) request.hold_back = {Role::candidates};
    if (options.quad_reward > 0) request.wants = {Role::mesh};
    pipeline::StageData data = stage.read(request);
    phases.end("read");
    const InputNames names{.candidates = stage.source_of(Role::candidates), .mesh = stage.source_of(Role::mesh)};
    const BuildgraphResult result = buildgraph::buildgraph(std::move(data), options, names);
    phases.end("build");
    const GraphSummary summary = summarize(result);
    for (const auto& warning : warnings_about(summary)) context.warn(warning);
    for (const auto& line : summary_lines(summary)) context.note(line);
    context.statistics.update(to_json(summary));
    // The candidates come first beside a .graph, which is of no use without them; a bundle has them itself.
    const auto write_reduced = [&] { formats::write_cand(result.product.candidates->candidates, *reduced); };
    if (reduced && !stage.writes_bundle()) {
      write_reduced();
      reduced->drain();
    }
    stage.write(result.product, history_of(summary));
    if (reduced && stage.writes_bundle()) write_reduced();
    if (reduced) reduced->commit();
    phases.end("write");
    context.statistics.update(phases.seconds());
  };
  return tool_main(argc, argv, info, declare, run);
}
