#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "common/mwis/bounds/gap_shares.hpp"
#include "common/mwis/ground/search_log.hpp"
#include "common/mwis/ground/target_weight.hpp"
#include "common/mwis/lns_options.hpp"
#include "common/mwis/local_search/lns.hpp"
#include "common/run/progress.hpp"
#include "common/run/tool_main.hpp"
#include "formats/choice/fragments_file.hpp"
#include "formats/pipeline/stage.hpp"

using namespace hexpipe;

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "lns",
      .summary = "Improve a choice of candidates: free a fragment, solve it exactly or anneal it, go on.",
      .example = "lns --graph part.graph --solution part.sol --time-limit 60 -o better.sol",
      .reads = {Role::graph, Role::solution},
      .product = Role::solution,
      .random = true,
      .searches = true,
      .default_time_limit = 60,
      .outside_history = {"fragments"}};
  mwis::local_search::LnsOptions options;
  mwis::TargetOptions target;
  std::string fragments_file;
  const auto declare = [&](CLI::App& app) {
    mwis::declare_lns_options(app, options, target);
    app.add_option(
           "--fragments", fragments_file,
           "Write the fragments that were improved to a file, a line each, to look at with viewmesh --fragments")
        ->type_name("FILE");
  };
  const auto run = [&](RunContext& context) {
    mwis::check(target);
    options.seed = context.common.seed;
    options.iterations = context.common.iterations.value_or(options.iterations);
    pipeline::Stage stage(context);
    mwis::ground::SearchLog log(context.common.log_file);
    std::optional<formats::FragmentsFile> fragments;
    if (!fragments_file.empty()) fragments.emplace(fragments_file);
    const pipeline::StageData data = stage.read({Role::graph, Role::solution});
    const bool graph_of_bundle = !context.streams.files.contains(Role::graph);
    if (target.gap)
      options.target = mwis::ground::target_weight(
          *target.gap, target.bound || !graph_of_bundle ? target.bound : mwis::ground::bound_in(data.history));

    if (data.gaps)
      options.first_places = mwis::bounds::holds_most_of_gap(data.graph->vertex_count(), *data.solution, *data.gaps);
    const Deadline deadline = context.deadline();
    Progress progress("lns", context.common.quiet);
    const mwis::local_search::LnsResult result = mwis::local_search::improve_by_lns(
        *data.graph, *data.solution, options, deadline, [&](const mwis::local_search::LnsProgress& now) {
          log.record(deadline.elapsed(), now.iteration, now.weight);
          if (fragments) fragments->add(std::vector<std::uint64_t>(now.fragment.begin(), now.fragment.end()));
          if (progress.due()) progress.show(fmt::format("weight {} after {} fragments", now.weight, now.iteration));
        });
    const double seconds = deadline.elapsed();
    context.statistics["weight"] = result.weight;
    context.statistics["chosen"] = result.solution.size();
    context.statistics["iterations"] = result.iterations;
    context.statistics["improvements"] = result.improvements;
    context.statistics["complete"] = result.complete;
    context.note(fmt::format("{} chosen, weight {}{}, {} of {} fragments were improved", result.solution.size(),
                             result.weight, result.complete ? " (optimal)" : "", result.improvements,
                             result.iterations));
    nlohmann::ordered_json details{
        {"weight", result.weight}, {"iterations", result.iterations}, {"complete", result.complete}};
    if (options.free_running) details["depends_on_timing"] = true;
    stage.write(result.solution, details);
    // Behind the solution, which no full disk under them may cost.
    if (fragments) fragments->commit();
    log.finish(seconds, result.iterations, result.weight);
  };
  return tool_main(argc, argv, info, declare, run);
}
