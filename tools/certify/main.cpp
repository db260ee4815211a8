#include <fmt/format.h>

#include <optional>
#include <utility>

#include "common/graph/clique_cover.hpp"
#include "common/mwis/bounds/gap_shares.hpp"
#include "common/mwis/ground/search_log.hpp"
#include "common/mwis/ground/target_weight.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/progress.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/quads_of_choice.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/certify/certify.hpp"

using namespace hexpipe;
using namespace hexpipe::certify;

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "certify",
      .summary = "Prove an upper bound on any choice of candidates, and the distance of this choice from it.",
      .example = "certify --graph part.graph --solution part.sol -v -o part.sol",
      .reads = {Role::graph, Role::solution},
      .product = Role::solution,
      .searches = true};
  CertifyOptions options;
  bool exact = false;
  std::string algorithm = mwis::default_exact_algorithm();
  const auto declare = [&](CLI::App& app) {
    outside_history(app.add_option("--certificate", options.certificate,
                                   "Write the proof of the bound to a file: prices of cliques"))
        ->group("Proof")
        ->type_name("FILE");
    CLI::Option* const with_exact =
        app.add_flag("--exact", exact, "Go on to prove optimality; that bound has no certificate");
    app.add_option("--algorithm", algorithm, "The algorithm of --exact")
        ->group("Proof")
        ->check(one_of(mwis::exact_algorithms()))
        ->needs(with_exact);
  };
  const auto run = [&](RunContext& context) {
    if (exact) options.exact = mwis::exact_algorithms().at(algorithm);
    options.passes = context.common.iterations;
    pipeline::Stage stage(context);
    mwis::ground::SearchLog log(context.common.log_file, "bound");
    std::optional<formats::Output> proof;
    if (!options.certificate.empty()) proof.emplace(options.certificate);
    const pipeline::StageData data =
        stage.read({.needs = {Role::graph, Role::solution}, .wants = {Role::candidates}, .cover = true});
    KnownCliques known{data.cover, std::nullopt};
    if (data.candidates) {
      known.of_tets = graph::cliques_of_tets(*data.candidates);
      graph::add_cliques_at_last(*data.graph, data.graph->vertex_count() - pipeline::quad_count(data), *known.of_tets);
    }
    const Deadline deadline = context.deadline();
    Step step("proving a bound");
    const std::int64_t weight = graph::total_weight(*data.solution, *data.graph);
    CertifyResult result = certify::certify(
        *data.graph, *data.solution, std::move(known), options, deadline, [&](const mwis::bounds::CliqueDual& now) {
          log.record(deadline.elapsed(), now.passes, now.bound);
          if (step.due()) step.say(fmt::format("gap {:.3f} %", 100 * mwis::ground::gap_to(now.bound, weight)));
        });
    const double seconds = deadline.elapsed();
    context.statistics.update(to_json(result));
    context.note(summary(result));
    pipeline::report_candidates(context, result.solution, data, result.bound);
    pipeline::SolutionProduct product{.solution = std::move(result.solution)};
    if (stage.writes_bundle())
      product.gaps = mwis::bounds::gap_shares(*data.graph, result.cover, result.dual.prices, product.solution);
    stage.write(
        product,
        {{"weight", result.weight}, {"bound", result.bound}, {"gap", result.gap}, {"complete", result.complete}});
    // After the solution, so that a full disk under them does not cost it; the proof, which takes longer to make again,
    // comes first.
    if (proof) {
      write_certificate(result.cover, result.dual, *proof);
      proof->commit();
    }
    log.finish(seconds, result.dual.passes, result.bound);
  };
  return tool_main(argc, argv, info, declare, run);
}
