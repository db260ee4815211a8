#include <fmt/format.h>

#include <map>

#include "common/mwis/ground/search_log.hpp"
#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/progress.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/initsol/initsol.hpp"

using namespace hexpipe;
using namespace hexpipe::initsol;

namespace {

const std::map<std::string, GreedyOrder> orders{
    {"weight", GreedyOrder::weight}, {"weight-degree", GreedyOrder::weight_degree}, {"quality", GreedyOrder::quality}};
const std::map<std::string, Method> methods{
    {"anneal", Method::anneal}, {"tabu", Method::tabu}, {"descend", Method::descend}};
const std::map<std::string, Escape> escapes{
    {"restart", Escape::restart}, {"rebuild", Escape::rebuild}, {"best", Escape::best}};

std::vector<double> quality_for(const pipeline::StageData& data) {
  if (!data.candidates)
    throw DataError("--greedy quality needs candidates: found none in the bundle, give --candidates");
  if (data.candidates->size() != data.graph->weights.size())
    throw DataError(fmt::format("expected as many candidates as vertices of the graph, {}, found {}",
                                data.graph->vertex_count(), data.candidates->size()));
  return data.candidates->quality;
}

// Options of other methods would do nothing.
void refuse_options(const std::vector<CLI::Option*>& others, const std::string& method) {
  for (const CLI::Option* option : others)
    if (option->count() > 0)
      throw UsageError(fmt::format("{} is no option of --method {}", option->get_name(), method));
}

}  // namespace

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "initsol",
      .summary = "Choose a first set of candidates without conflicts: greedy, then annealing or tabu search.",
      .example = "initsol part.graph --time-limit 5 -o part.sol",
      .reads = {Role::graph, Role::candidates},
      .product = Role::solution,
      .random = true,
      .searches = true,
      .default_time_limit = 10};
  InitsolOptions options;
  std::string order = "weight-degree", method = "anneal", escape = "best";
  std::vector<CLI::Option*> of_annealing, of_tabu;
  const auto declare = [&](CLI::App& app) {
    app.add_option("--greedy", order, "What comes first: high weight, weight / (degree + 1), or quality")
        ->check(CLI::IsMember(orders));
    app.add_option(
           "--method", method,
           "What follows greedy: simulated annealing over local optima, tabu search, or just a descent to the next one")
        ->check(CLI::IsMember(methods));
    of_annealing = {app.add_option("--hot", options.cooling.hot,
                                   "Annealing: the first temperature, in mean weights of a chosen vertex")
                        ->check(number_between(1e-6, 1e6)),
                    app.add_option("--cold", options.cooling.cold, "Annealing: the last temperature, likewise")
                        ->check(number_between(1e-6, 1e6))};
    of_tabu = {
        app.add_option("--escape", escape,
                       "Tabu search: the way out of local optima: restart at random, rebuild from what moved least, go "
                       "back to the best")
            ->check(CLI::IsMember(escapes)),
        app.add_option("--tenure", options.tabu.tenure,
                       "Tabu search: moves, or up to twice as many, that a vertex pushed out stays out")
            ->check(CLI::Range(0, 1000000000).description("")),
        app.add_option("--patience", options.tabu.patience,
                       "Tabu search: moves without a better solution before the way out")
            ->check(CLI::Range(1, 1000000000).description(""))};
    app.add_option("--starts", options.starts, "Searches from different starts, whose results are recombined")
        ->check(CLI::Range(1, 1000).description(""));
  };
  const auto run = [&](RunContext& context) {
    options.order = orders.at(order);
    options.method = methods.at(method);
    if (options.method != Method::anneal) refuse_options(of_annealing, method);
    if (options.method != Method::tabu) refuse_options(of_tabu, method);
    options.tabu.escape = escapes.at(escape);
    options.seed = context.common.seed;
    options.iterations = context.common.iterations.value_or(options.iterations);
    pipeline::Stage stage(context);
    mwis::ground::SearchLog log(context.common.log_file);
    const bool by_quality = options.order == GreedyOrder::quality;
    const pipeline::StageData data =
        stage.read({Role::graph}, by_quality ? std::vector{Role::candidates} : std::vector<Role>{});
    const std::vector<double> quality = by_quality ? quality_for(data) : std::vector<double>{};

    const Deadline deadline = context.deadline();
    Progress progress("initsol", context.common.quiet);
    const InitsolResult result =
        find_initial_solution(*data.graph, quality, options, deadline, [&](const InitsolProgress& now) {
          log.record(deadline.elapsed(), now.iteration, now.weight);
          if (progress.due()) progress.show(fmt::format("weight {}", now.weight));
        });
    const double seconds = deadline.elapsed();
    context.statistics["greedy_weight"] = result.greedy_weight;
    context.statistics["weight"] = result.weight;
    context.statistics["chosen"] = result.solution.size();
    context.statistics["iterations"] = result.iterations;
    context.note(fmt::format("{} chosen, weight {} (greedy {}), {} moves", result.solution.size(), result.weight,
                             result.greedy_weight, result.iterations));
    stage.write(result.solution, {{"weight", result.weight}, {"iterations", result.iterations}});
    // Behind the solution, which no full disk under it may cost.
    log.finish(seconds, result.iterations, result.weight);
  };
  return tool_main(argc, argv, info, declare, run);
}
