#include <fmt/format.h>

#include <map>

#include "common/mwis/ground/search_log.hpp"
#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/progress.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/choice_progress.hpp"
#include "formats/pipeline/quads_of_choice.hpp"
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

// For a search without a limit. On random-33k, 27 find all that slower cooling does (tests/bench/mwis/README.md). Half
// of that leaves the rest to lns, and a lattice of 6 x 6 x 6 hexes takes half a second.
constexpr std::int64_t usual_iterations_a_vertex = 15;

std::vector<double> quality_for(const pipeline::StageData& data) {
  if (!data.candidates)
    throw DataError("--greedy quality needs candidates: found none in the bundle, give --candidates");
  const std::int32_t vertices = data.graph->vertex_count() - pipeline::quad_count(data);
  if (data.candidates->size() != static_cast<std::size_t>(vertices))
    throw DataError(fmt::format("expected as many candidates as vertices of the graph, {}, found {}", vertices,
                                data.candidates->size()));
  return data.candidates->quality;
}

// The command line, with values by name until they are checked.
struct CommandLine {
  InitsolOptions options;
  std::string order = "weight-degree", method = "anneal", escape = "best";
  std::vector<CLI::Option*> of_annealing, of_tabu;
};

void declare_annealing(CLI::App& app, CommandLine& line) {
  begin_group(app, group::experts);
  line.of_annealing = {
      app.add_option("--hot", line.options.hot,
                     "Annealing: the first temperature, in mean weights of a chosen vertex; lower to keep more of the "
                     "greedy start. If this or --cold is given, dense graphs get no short coolings [0.3, higher if few "
                     "are chosen]")
          ->check(number_between(1e-6, 1e6)),
      app.add_option("--cold", line.options.cold,
                     "Annealing: the last temperature, in the same unit [0.03, higher if few are chosen]")
          ->check(number_between(1e-6, 1e6))};
}

void declare_tabu_search(CLI::App& app, CommandLine& line) {
  TabuOptions& tabu = line.options.tabu;
  line.of_tabu = {
      app.add_option("--escape", line.escape,
                     "Tabu search: the way out of local optima: restart at random, rebuild from the vertices that "
                     "moved least, or go back to the best solution; try another one where --log shows no gain for long")
          ->check(one_of(escapes)),
      app.add_option("--tenure", tabu.tenure,
                     "Tabu search: a vertex that was pushed out stays out for this many moves, or up to twice as many; "
                     "less for graphs of few hundred vertices")
          ->check(whole_number_between(0, 1000000000).description("")),
      app.add_option("--patience", tabu.patience, "Tabu search: moves without a better solution before the way out")
          ->check(whole_number_between(1, 1000000000).description(""))};
}

void declare(CLI::App& app, CommandLine& line) {
  begin_group(app, "Search");
  app.add_option("--greedy", line.order, "Greedy takes first: high weight, high weight / (degree + 1), or high quality")
      ->check(one_of(orders));
  app.add_option("--method", line.method,
                 "The search after greedy: simulated annealing over local optima, tabu search, or a descent to the "
                 "next optimum")
      ->group(group::first)
      ->check(one_of(methods));
  declare_annealing(app, line);
  declare_tabu_search(app, line);
  begin_group(app, "Search");
  app.add_option("--starts", line.options.starts, "Run searches from this many starts, and recombine their results")
      ->check(whole_number_between(1, 1000).description(""));
  app.add_flag("!--no-reductions", line.options.reduce,
               "Search the whole graph, not what exact reductions and the solution of small components leave");
}

// Options of other methods would do nothing.
void refuse_options(const std::vector<CLI::Option*>& others, const std::string& method) {
  for (const CLI::Option* option : others)
    if (option->count() > 0)
      throw UsageError(fmt::format("{} is no option of --method {}", option->get_name(), method));
}

InitsolOptions checked_options(const CommandLine& line, const CommonOptions& common) {
  InitsolOptions options = line.options;
  options.order = orders.at(line.order);
  options.method = methods.at(line.method);
  if (options.method != Method::anneal) refuse_options(line.of_annealing, line.method);
  if (options.method != Method::tabu) refuse_options(line.of_tabu, line.method);
  options.tabu.escape = escapes.at(line.escape);
  options.seed = common.seed;
  options.iterations = common.iterations.value_or(options.iterations);
  if (!common.iterations && !common.time_limit) {
    options.iterations_a_vertex = usual_iterations_a_vertex;
    options.tries_first = true;
  }
  return options;
}

void run(RunContext& context, InitsolOptions options) {
  pipeline::Stage stage(context);
  mwis::ground::SearchLog log(context.common.log_file);
  const bool by_quality = options.order == GreedyOrder::quality;
  const pipeline::StageData data =
      stage.read({.needs = {Role::graph},
                  .wants = by_quality ? std::vector{Role::candidates} : std::vector<Role>{},
                  .volumes = true});
  const std::vector<double> quality = by_quality ? quality_for(data) : std::vector<double>{};

  options.quads = pipeline::quad_count(data);
  const Deadline deadline = context.deadline();
  Step step("choosing hexes");
  pipeline::ChoiceProgress progress(step, data, !context.streams.files.contains(Role::graph));
  const InitsolResult result =
      find_initial_solution(*data.graph, quality, options, deadline, [&](const InitsolProgress& now) {
        log.record(deadline.elapsed(), now.iteration, now.weight);
        progress.show(now.weight, now.solution);
      });
  const double seconds = deadline.elapsed();
  context.statistics.update(nlohmann::ordered_json{{"greedy_weight", result.greedy_weight},
                                                   {"weight", result.weight},
                                                   {"chosen", result.solution.size()},
                                                   {"iterations", result.iterations},
                                                   {"complete", result.complete}});
  context.note(fmt::format("{} chosen, weight {}{} (greedy {}), {} moves", result.solution.size(), result.weight,
                           result.complete ? " (optimal)" : "", result.greedy_weight, result.iterations));
  pipeline::report_candidates(context, result.solution, data);
  stage.write(pipeline::SolutionProduct{result.solution},
              {{"weight", result.weight}, {"iterations", result.iterations}, {"complete", result.complete}});
  // After the solution, so that a full disk under the log does not cost it.
  log.finish(seconds, result.iterations, result.weight);
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
      .ends_by_itself = "when it has cooled slowly enough for the graph"};
  CommandLine line;
  return tool_main(
      argc, argv, info, [&](CLI::App& app) { declare(app, line); },
      [&](RunContext& context) { run(context, checked_options(line, context.common)); });
}
