#include <fmt/format.h>

#include <map>
#include <optional>
#include <utility>

#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/phases.hpp"
#include "common/run/tool_main.hpp"
#include "formats/choice/cand.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/buildgraph/buildgraph.hpp"
#include "tools/buildgraph/report.hpp"

using namespace hexpipe;
using namespace hexpipe::buildgraph;

namespace {

// A part of a mesh and its neighbours.
buildgraph::PartGraph build_part(pipeline::StageData data, const BuildgraphOptions& options,
                                 const std::vector<std::string>& neighbours, const std::string& source) {
  if (options.conflicts.part.count > 1 || options.reduce || options.cover)
    throw UsageError(
        fmt::format("--part, --reduce and --cover need the whole graph, not that of {}", title_of(*data.part)));
  if (!data.candidate_keys)
    throw DataError::at(source, "expected candidates with their keys, as findhex makes them of a part, found none");
  PartCandidates own{std::move(*data.candidates), std::move(*data.candidate_keys)};
  return buildgraph_of_part(with_neighbours(std::move(own), *data.part, data.history, neighbours, source),
                            data.part->part, options, source.c_str());
}

// What is written has to be understood later: a graph of fewer candidates needs these beside it.
void check_together(const BuildgraphOptions& options, const std::string& reduced_candidates, bool to_bundle) {
  if (options.conflicts.part.count > 1 && (options.reduce || options.cover))
    throw UsageError("--part does not go with --reduce and --cover: they need the whole graph");
  if (!options.reduce && !reduced_candidates.empty())
    throw UsageError("--reduced-candidates does nothing without --reduce");
  if (options.reduce && !to_bundle && reduced_candidates.empty())
    throw UsageError("--reduce to a .graph needs --reduced-candidates FILE, of which its vertices are the lines");
  if (options.cover && !to_bundle) throw UsageError("--cover needs a bundle to be written to: a .tar, or a pipe");
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, conflicts::WeightKind> weights{{"quality", conflicts::WeightKind::quality},
                                                             {"volume", conflicts::WeightKind::volume},
                                                             {"count", conflicts::WeightKind::count},
                                                             {"quality*volume", conflicts::WeightKind::quality_volume}};
  const ToolInfo info{
      .name = "buildgraph",
      .summary = "Compare candidates: the graph of those that cannot both be chosen.",
      .example = "buildgraph engine.cand --weight volume -o engine.graph",
      .reads = {Role::candidates},
      .product = Role::graph,
      .outside_history = {"reduced-candidates", "neighbours"},
  };
  BuildgraphOptions options;
  std::vector<std::string> neighbours;
  std::string weight = "quality", part = "1/1", reduced_candidates;
  const auto declare = [&](CLI::App& app) {
    app.add_option("--weight", weight, "What a candidate is worth: quality, volume, count (1 each) or quality*volume")
        ->check(CLI::IsMember(weights));
    app.add_option("--weight-scale", options.conflicts.weight_scale,
                   "Weights are rounded after multiplication with this")
        ->check(number_between(1e-100, 1e100));
    app.add_option("--part", part,
                   "i/k: only conflicts whose higher candidate is in part i of k; see Makefile.examples");
    app.add_flag("--reduce", options.reduce,
                 "Leave out candidates that no choice needs: another one has no conflict more and weighs no less");
    app.add_option("--reduced-candidates", reduced_candidates,
                   "With --reduce: write the candidates that are left, vertex by vertex, to a .cand")
        ->type_name("FILE");
    app.add_option("--neighbours", neighbours,
                   "With a part of a mesh: bundles of the other parts' candidates, of which those beside it are read")
        ->type_name("FILE");
    app.add_flag("--cover", options.cover,
                 "Add an edge clique cover to the bundle: cliques at tets, grown, then what they miss");
  };
  const auto run = [&](RunContext& context) {
    options.conflicts.weight = weights.at(weight);
    options.conflicts.part = parse_part(part);
    Phases phases;
    pipeline::Stage stage(context);
    check_together(options, reduced_candidates, stage.writes_bundle());
    if (options.reduce || !neighbours.empty()) stage.hold_back(Role::candidates);
    stage.take_part();
    std::optional<formats::Output> reduced;
    if (!reduced_candidates.empty()) reduced.emplace(reduced_candidates);
    pipeline::StageData data = stage.read({Role::candidates});
    const std::string source = stage.source_of(Role::candidates);
    phases.end("read");
    if (!data.part && !neighbours.empty())
      throw UsageError("--neighbours goes with the candidates of a part of a mesh, as mesh-part makes them");
    const auto [result, of_part] =
        data.part ? build_part(std::move(data), options, neighbours, source)
                  : PartGraph{buildgraph::buildgraph(std::move(*data.candidates), options, source.c_str()), {}};
    phases.end("build");
    const GraphSummary summary = summarize(result);
    for (const auto& warning : warnings_about(summary)) context.warn(warning);
    for (const auto& line : summary_lines(summary)) context.note(line);
    context.statistics.update(to_json(summary));
    // A .graph is of no use without them, a bundle has them itself.
    if (reduced && !stage.writes_bundle()) {
      formats::write_cand(*result.candidates, *reduced);
      reduced->drain();
    }
    const Candidates* const candidates = !neighbours.empty() ? &of_part.candidates
                                         : result.candidates ? &*result.candidates
                                                             : nullptr;
    stage.write(result.graph, neighbours.empty() ? nullptr : &of_part.keys, candidates,
                result.cover ? &*result.cover : nullptr, history_of(summary));
    if (reduced && stage.writes_bundle()) formats::write_cand(*result.candidates, *reduced);
    if (reduced) reduced->commit();
    phases.end("write");
    context.statistics.update(phases.seconds());
  };
  return tool_main(argc, argv, info, declare, run);
}
