#include <fmt/format.h>

#include "common/mwis/search_log.hpp"
#include "common/run/progress.hpp"
#include "common/run/tool_main.hpp"
#include "formats/stage.hpp"
#include "tools/lns/lns.hpp"

using namespace hexpipe;

int main(int argc, char** argv) {
  const ToolInfo info{.name = "lns",
                      .summary = "Improve a choice of candidates: free a fragment, solve it exactly, go on.",
                      .example = "lns --graph part.graph --solution part.sol --time-limit 60 -o better.sol",
                      .reads = {Role::graph, Role::solution},
                      .product = Role::solution,
                      .random = true,
                      .searches = true,
                      .default_time_limit = 60};
  LnsOptions options;
  const auto declare = [&](CLI::App& app) {
    app.add_option("--fragment-size", options.fragment_size, "Vertices of the first fragments; the size adapts")
        ->check(CLI::Range(1, 4096).description(""));
    app.add_option("--largest-fragment", options.largest_fragment, "Vertices of a fragment at most")
        ->check(CLI::Range(1, 4096).description(""));
    app.add_option("--node-limit", options.node_limit, "Nodes of branch and bound for a fragment at most")
        ->check(CLI::Range(1, 1000000000).description(""));
    app.add_option("--batch", options.batch,
                   "Fragments in a round, which are solved in parallel and put together in order")
        ->check(CLI::Range(1, 10000).description(""));
    app.add_flag("!--no-reductions", options.reduce,
                 "Search the whole graph, not the kernel that exact reductions leave");
  };
  const auto run = [&](RunContext& context) {
    options.seed = context.common.seed;
    options.iterations = context.common.iterations.value_or(options.iterations);
    Stage stage(context);
    SearchLog log(context.common.log_file);
    const StageData data = stage.read({Role::graph, Role::solution});

    const Deadline deadline = context.deadline();
    Progress progress("lns", context.common.quiet);
    const LnsResult result =
        improve_by_lns(*data.graph, *data.solution, options, deadline, [&](const LnsProgress& now) {
          log.record(deadline.elapsed(), now.iteration, now.weight);
          if (progress.due()) progress.show(fmt::format("weight {} after {} fragments", now.weight, now.iteration));
        });
    log.finish(deadline.elapsed(), result.iterations, result.weight);
    context.statistics["weight"] = result.weight;
    context.statistics["chosen"] = result.solution.size();
    context.statistics["iterations"] = result.iterations;
    context.statistics["improvements"] = result.improvements;
    context.statistics["complete"] = result.complete;
    context.note(fmt::format("{} chosen, weight {}{}, {} of {} fragments were improved", result.solution.size(),
                             result.weight, result.complete ? " (optimal)" : "", result.improvements,
                             result.iterations));
    stage.write(result.solution,
                {{"weight", result.weight}, {"iterations", result.iterations}, {"complete", result.complete}});
  };
  return tool_main(argc, argv, info, declare, run);
}
