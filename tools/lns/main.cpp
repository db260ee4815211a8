#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "common/mwis/search_log.hpp"
#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/progress.hpp"
#include "common/run/tool_main.hpp"
#include "formats/output.hpp"
#include "formats/stage.hpp"
#include "tools/lns/lns.hpp"

using namespace hexpipe;

namespace {

// The lowest bound that certify has proven since the graph was made.
std::optional<std::int64_t> bound_in(const std::vector<nlohmann::ordered_json>& history) {
  std::optional<std::int64_t> lowest;
  for (const auto& entry : history) {
    if (!entry.is_object() || !entry.contains("tool")) continue;
    const auto& tool = entry["tool"];
    if (tool == "tetmesh" || tool == "findhex" || tool == "buildgraph") lowest.reset();
    const auto bound = entry.find("bound");
    if (tool != "certify" || bound == entry.end() || !bound->is_number_integer()) continue;
    lowest = std::min(lowest.value_or(bound->get<std::int64_t>()), bound->get<std::int64_t>());
  }
  return lowest;
}

// The least weight whose gap to the bound is no more than this.
std::int64_t target_weight(double gap, std::optional<std::int64_t> bound) {
  if (!bound) throw DataError("--target-gap needs a bound: pipe the solution through certify first, or give --bound");
  return *bound - static_cast<std::int64_t>(std::floor(static_cast<long double>(*bound) * gap));
}

// A line each, the numbers of its candidates from 1, as view reads them.
void write_fragment(Output& output, std::span<const std::int32_t> fragment) {
  const char* separator = "";
  for (const std::int32_t v : fragment) {
    output.print("{}{}", separator, v + 1);
    separator = " ";
  }
  output.print("\n");
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
      .default_time_limit = 60};
  LnsOptions options;
  std::optional<double> target_gap;
  std::optional<std::int64_t> known_bound;
  std::string fragments_file;
  const auto declare = [&](CLI::App& app) {
    app.add_option("--fragment-size", options.fragment_size, "Vertices of the first fragments; the size adapts")
        ->check(CLI::Range(1, 4096).description(""));
    app.add_option("--largest-fragment", options.largest_fragment, "Vertices of a fragment at most")
        ->check(CLI::Range(1, 4096).description(""));
    app.add_option("--node-limit", options.node_limit, "Nodes of branch and bound for a fragment at most")
        ->check(CLI::Range(1, 1000000000).description(""));
    app.add_option("--annealed-fragment", options.annealed_fragment,
                   "Vertices of the larger fragments that are annealed in between; 0: none are")
        ->check(CLI::Range(0, 1000000).description(""));
    app.add_option("--batch", options.batch,
                   "Fragments in a round, which are solved in parallel and put together in order")
        ->check(CLI::Range(1, 10000).description(""));
    app.add_flag("!--no-reductions", options.reduce,
                 "Search the whole graph, not the kernel that exact reductions leave");
    app.add_option(
           "--target-gap", target_gap,
           "Stop when (bound - weight) / bound is no more than this; the bound is what certify left in the bundle")
        ->type_name("FRACTION")
        ->check(number_between(0, 1));
    app.add_option("--bound", known_bound, "An upper bound that is known, for --target-gap")
        ->type_name("WEIGHT")
        ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()).description(""));
    app.add_option("--fragments", fragments_file,
                   "Write the fragments that were improved to a file, a line each, to look at with view --fragments")
        ->type_name("FILE");
    app.add_flag("--free-running", options.free_running,
                 "Threads do not wait for each other: faster, but the result depends on the timing");
  };
  const auto run = [&](RunContext& context) {
    if (known_bound && !target_gap) throw UsageError("--bound does nothing without --target-gap");
    options.seed = context.common.seed;
    options.iterations = context.common.iterations.value_or(options.iterations);
    Stage stage(context);
    SearchLog log(context.common.log_file);
    const StageData data = stage.read({Role::graph, Role::solution});
    const bool graph_of_bundle = !context.streams.files.contains(Role::graph);
    if (target_gap)
      options.target =
          target_weight(*target_gap, known_bound || !graph_of_bundle ? known_bound : bound_in(data.history));

    std::optional<Output> fragments;
    if (!fragments_file.empty()) fragments.emplace(fragments_file);
    const Deadline deadline = context.deadline();
    Progress progress("lns", context.common.quiet);
    const LnsResult result =
        improve_by_lns(*data.graph, *data.solution, options, deadline, [&](const LnsProgress& now) {
          log.record(deadline.elapsed(), now.iteration, now.weight);
          if (fragments) write_fragment(*fragments, now.fragment);
          if (progress.due()) progress.show(fmt::format("weight {} after {} fragments", now.weight, now.iteration));
        });
    log.finish(deadline.elapsed(), result.iterations, result.weight);
    if (fragments) fragments->commit();
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
  };
  return tool_main(argc, argv, info, declare, run);
}
