#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/mwis/bounds/gap_shares.hpp"
#include "common/mwis/ground/search_log.hpp"
#include "common/mwis/ground/target_weight.hpp"
#include "common/mwis/lns_options.hpp"
#include "common/mwis/local_search/lns.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/progress.hpp"
#include "common/run/tool_main.hpp"
#include "formats/choice/fragments_file.hpp"
#include "formats/pipeline/choice_progress.hpp"
#include "formats/pipeline/quads_of_choice.hpp"
#include "formats/pipeline/stage.hpp"

using namespace hexpipe;

namespace {

// For a search without a limit. Each doubling of the time gains half as much or less, so about this share is left to
// gain when the search ends.
constexpr double usual_worth = 5e-5;

// Without the vertices of quads behind the candidates.
std::vector<std::uint64_t> candidates_of(std::span<const std::int32_t> fragment, std::int32_t candidates) {
  std::vector<std::uint64_t> result;
  for (const std::int32_t v : fragment)
    if (v < candidates) result.push_back(static_cast<std::uint64_t>(v));
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "lns",
      .summary = "Improve a choice of candidates: free a fragment, solve it exactly or anneal it, go on.",
      .example = "lns --graph part.graph --solution part.sol --time-limit 60 -o better.sol",
      .reads = {Role::graph, Role::solution},
      .product = Role::solution,
      .random = true,
      .searches = true,
      .ends_by_itself = "when --worth says so"};
  mwis::local_search::LnsOptions options;
  mwis::TargetOptions target;
  std::string fragments_file;
  std::optional<double> worth;
  const auto declare = [&](CLI::App& app) {
    mwis::declare_lns_options(app, options, target);
    app.add_option("--worth", worth,
                   "End when the last half of the search gained less than this share of the weight [5e-5 if neither "
                   "--time-limit nor --iterations is given, otherwise 0: go on to the limit]")
        ->type_name("SHARE")
        ->check(number_between(0, 1));
    outside_history(
        app.add_option("--fragments", fragments_file,
                       "Write each improved fragment as a line of a file, to look at with viewmesh --fragments"))
        ->group(group::output)
        ->type_name("FILE");
  };
  const auto run = [&](RunContext& context) {
    mwis::check(target);
    options.seed = context.common.seed;
    options.iterations = context.common.iterations.value_or(options.iterations);
    const bool is_limited = context.common.iterations || context.common.time_limit;
    options.worth = worth.value_or(is_limited ? 0 : usual_worth);
    pipeline::Stage stage(context);
    mwis::ground::SearchLog log(context.common.log_file);
    std::optional<formats::FragmentsFile> fragments;
    if (!fragments_file.empty()) fragments.emplace(fragments_file);
    const pipeline::StageData data = stage.read({.needs = {Role::graph, Role::solution}, .volumes = true});
    const bool graph_of_bundle = !context.streams.files.contains(Role::graph);
    const auto bound = target.bound || !graph_of_bundle ? target.bound : mwis::ground::bound_in(data.history);
    if (target.gap) options.target = mwis::ground::target_weight(*target.gap, bound, pipeline::weight_of_quads(data));

    // No search is needed to find again what one has proven.
    constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::max();
    const std::int64_t optimum = graph_of_bundle ? mwis::ground::optimum_in(data.history).value_or(unknown) : unknown;
    options.target = std::min(options.target, optimum);

    if (data.gaps)
      options.first_places = mwis::bounds::holds_most_of_gap(data.graph->vertex_count(), *data.solution, *data.gaps);
    const std::int32_t candidates = data.graph->vertex_count() - pipeline::quad_count(data);
    const Deadline deadline = context.deadline();
    Step step("improving the choice");
    pipeline::ChoiceProgress progress(step, data, graph_of_bundle);
    progress.show(graph::total_weight(*data.solution, *data.graph), [&] { return *data.solution; });
    mwis::local_search::LnsResult result = mwis::local_search::improve_by_lns(
        *data.graph, *data.solution, options, deadline, [&](const mwis::local_search::LnsProgress& now) {
          log.record(deadline.elapsed(), now.iteration, now.weight);
          if (fragments)
            if (const auto shown = candidates_of(now.fragment, candidates); !shown.empty()) fragments->add(shown);
          progress.show(now.weight, now.solution);
        });
    const double seconds = deadline.elapsed();
    result.complete |= result.weight >= optimum;
    context.statistics["weight"] = result.weight;
    context.statistics["chosen"] = result.solution.size();
    context.statistics["iterations"] = result.iterations;
    context.statistics["improvements"] = result.improvements;
    context.statistics["complete"] = result.complete;
    context.note(fmt::format("{} chosen, weight {}{}, {} of {} fragments were improved", result.solution.size(),
                             result.weight, result.complete ? " (optimal)" : "", result.improvements,
                             result.iterations));
    pipeline::report_candidates(context, result.solution, data);
    nlohmann::ordered_json details{
        {"weight", result.weight}, {"iterations", result.iterations}, {"complete", result.complete}};
    if (options.free_running) details["depends_on_timing"] = true;
    stage.write(pipeline::SolutionProduct{result.solution}, details);
    // After the solution, so that a full disk under them does not cost it.
    if (fragments) fragments->commit();
    log.finish(seconds, result.iterations, result.weight);
  };
  return tool_main(argc, argv, info, declare, run);
}
