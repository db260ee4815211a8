#include <fmt/format.h>

#include <optional>
#include <utility>

#include "common/graph/tet_cliques.hpp"
#include "common/mwis/bounds/gap_shares.hpp"
#include "common/mwis/ground/search_log.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/certify/certificate.hpp"
#include "tools/certify/certify.hpp"

using namespace hexpipe;
using namespace hexpipe::certify;

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "certify",
      .summary = "Prove an upper bound on any choice of candidates, and tell how far from it this one is.",
      .example = "certify --graph part.graph --solution part.sol -v -o part.sol",
      .reads = {Role::graph, Role::solution},
      .product = Role::solution,
      .searches = true,
      .outside_history = {"certificate"}};
  CertifyOptions options;
  std::string certificate;
  bool exact = false;
  std::string algorithm = mwis::exact::default_exact_algorithm();
  const auto declare = [&](CLI::App& app) {
    app.add_option("--certificate", certificate, "Write the proof of the bound to a file: prices of cliques")
        ->type_name("FILE");
    CLI::Option* const with_exact =
        app.add_flag("--exact", exact, "Go on to a proof of optimality; its bound has no certificate");
    app.add_option("--algorithm", algorithm, "How --exact proves it")
        ->check(CLI::IsMember(mwis::exact::exact_algorithms()))
        ->needs(with_exact);
  };
  const auto run = [&](RunContext& context) {
    if (exact) {
      options.exact = mwis::exact::exact_algorithms().at(algorithm);
      options.dual.passes = passes_before_proof;
    }
    pipeline::Stage stage(context);
    stage.take_cover();
    mwis::ground::SearchLog log(context.common.log_file, "bound");
    std::optional<formats::Output> proof;
    if (!certificate.empty()) proof.emplace(certificate);
    const pipeline::StageData data = stage.read({Role::graph, Role::solution}, {Role::candidates});
    KnownCliques known{data.cover, std::nullopt};
    if (data.candidates) known.of_tets = graph::cliques_of_tets(*data.candidates);
    // Cliques at tets are fewer, and a pass over them is that much quicker.
    if (known.of_tets && !known.cover) options.dual.passes *= 2;
    options.dual.passes = context.common.iterations.value_or(options.dual.passes);
    const Deadline deadline = context.deadline();
    const CertifyResult result = certify::certify(
        *data.graph, *data.solution, std::move(known), options, deadline,
        [&](const mwis::bounds::CliqueDual& now) { log.record(deadline.elapsed(), now.passes, now.bound); });
    const double seconds = deadline.elapsed();
    context.statistics["weight"] = result.weight;
    context.statistics["bound"] = result.bound;
    context.statistics["gap"] = result.gap;
    context.statistics["complete"] = result.complete;
    context.statistics["maximal"] = result.maximal;
    context.statistics["cliques"] = result.cover.size();
    context.statistics["iterations"] = result.dual.passes;
    context.statistics["nodes"] = result.nodes;
    context.statistics["fixed_out"] = result.fixed_out;
    context.statistics["fixed_in"] = result.fixed_in;
    context.note(fmt::format("weight {}, at most {} is possible: gap {:.4f} %{}{}", result.weight, result.bound,
                             100 * result.gap, result.complete ? ", optimal" : "",
                             result.maximal ? "" : ", not maximal"));
    const std::vector<std::int64_t> gaps =
        stage.writes_bundle() ? mwis::bounds::gap_shares(*data.graph, result.cover, result.dual.prices, result.solution)
                              : std::vector<std::int64_t>();
    stage.write(
        result.solution,
        {{"weight", result.weight}, {"bound", result.bound}, {"gap", result.gap}, {"complete", result.complete}},
        &gaps);
    // Behind the solution, which no full disk under them may cost; the proof first, which takes longer to have again.
    if (proof) {
      write_certificate(result.cover, result.dual, *proof);
      proof->commit();
    }
    log.finish(seconds, result.dual.passes, result.bound);
  };
  return tool_main(argc, argv, info, declare, run);
}
