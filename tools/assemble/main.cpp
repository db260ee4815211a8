#include <fmt/format.h>

#include <map>

#include "common/mwis/target_weight.hpp"
#include "common/run/tool_main.hpp"
#include "formats/stage.hpp"
#include "tools/assemble/assemble.hpp"

using namespace hexpipe;

namespace {

// How good the choice is, where certify has proven a bound for its graph: weight, bound and gap.
nlohmann::ordered_json proven_gap(const StageData& data) {
  const auto bound = bound_in(data.history);
  if (!data.graph || !bound) return nullptr;
  const std::int64_t weight = total_weight(*data.solution, *data.graph);
  const auto gap = *bound > 0 ? static_cast<double>(*bound - weight) / static_cast<double>(*bound) : 0.0;
  return {{"weight", weight}, {"bound", *bound}, {"gap", gap}};
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, AssembleOptions::Conformity> conformities{
      {"pyramids", AssembleOptions::Conformity::pyramids}, {"none", AssembleOptions::Conformity::none}};
  const ToolInfo info{
      .name = "assemble",
      .summary = "Build the hex-dominant mesh from the chosen candidates and the tets that remain.",
      .example = "tetmesh bracket.stl --size 3 | findhex | buildgraph | initsol | assemble -v -o bracket.vtu",
      .reads = {Role::mesh, Role::candidates, Role::graph, Role::solution},
      .product = Role::result,
  };
  std::string conformity = "pyramids";
  int smooth = AssembleOptions{}.smooth;
  auto declare = [&](CLI::App& app) {
    app.add_option("--conformity", conformity,
                   "pyramids: every quad gets a cell on its other side; none: quads may face two triangles")
        ->check(CLI::IsMember(conformities))
        ->capture_default_str();
    app.add_option("--smooth", smooth,
                   "rounds of moving vertices and exchanging tets to make the worst cells better; 0: none")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
  };
  auto run = [&](RunContext& context) {
    const AssembleOptions options{.conformity = conformities.at(conformity), .smooth = smooth};
    context.options["conformity"] = conformity;
    context.options["smooth"] = smooth;
    Stage stage(context);
    const StageData data = stage.read({Role::mesh, Role::candidates, Role::solution}, {Role::graph});
    const AssembleResult result = assemble(*data.mesh, *data.candidates, *data.solution, options,
                                           {.mesh = stage.source_of(Role::mesh),
                                            .candidates = stage.source_of(Role::candidates),
                                            .solution = stage.source_of(Role::solution)});
    context.statistics = to_json(result.statistics);
    for (const auto& line : summary_lines(result.statistics)) context.note(line);
    nlohmann::ordered_json details{{"counts", context.statistics["cells"]}};
    const bool graph_of_bundle = !context.streams.files.contains(Role::graph);
    if (const auto choice = graph_of_bundle ? proven_gap(data) : nullptr; !choice.is_null()) {
      context.statistics["choice"] = details["choice"] = choice;
      context.note(fmt::format("the choice weighs {}, at most {} is possible: gap {:.4f} %",
                               choice["weight"].get<std::int64_t>(), choice["bound"].get<std::int64_t>(),
                               100 * choice["gap"].get<double>()));
    }
    stage.write(result.mesh, details);
  };
  return tool_main(argc, argv, info, declare, run);
}
