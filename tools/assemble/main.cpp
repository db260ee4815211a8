#include <fmt/format.h>

#include <map>
#include <utility>

#include "common/mwis/ground/target_weight.hpp"
#include "common/run/error.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/assemble/assemble.hpp"
#include "tools/assemble/assemble_part.hpp"

using namespace hexpipe;
using namespace hexpipe::assemble;

namespace {

// How good the choice is, where certify has proven a bound for its graph: weight, bound and gap.
nlohmann::ordered_json proven_gap(const pipeline::StageData& data) {
  const auto bound = mwis::ground::bound_in(data.history);
  if (!data.graph || !bound) return nullptr;
  const std::int64_t weight = graph::total_weight(*data.solution, *data.graph);
  return {{"weight", weight}, {"bound", *bound}, {"gap", mwis::ground::gap_to(*bound, weight)}};
}

pieces::SolvedPart solved_part(pipeline::StageData data, const choice::InputNames& names) {
  if (!data.part) throw UsageError("--neighbours goes with a part of a mesh, as mesh-part makes them");
  if (!data.candidate_keys)
    throw DataError::at(names.candidates,
                        "expected candidates with their keys, as findhex makes them of a part, found none");
  return {.part = std::move(*data.part),
          .mesh = std::move(*data.mesh),
          .candidates = std::move(*data.candidates),
          .keys = std::move(*data.candidate_keys),
          .chosen = std::move(*data.solution),
          .history = std::move(data.history)};
}

PartResult assemble_whole(pipeline::StageData data, const AssembleOptions& options, const choice::InputNames& names) {
  if (data.part && !data.part->neighbours.empty())
    throw DataError::at(names.mesh, "expected the neighbours of {} with --neighbours, found none",
                        title_of(*data.part));
  AssembleResult result = assemble::assemble(std::move(*data.mesh), *data.candidates, *data.solution, options, names);
  return {std::move(result.mesh), std::move(result.statistics), {}};
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
      .outside_history = {"neighbours", "before"},
  };
  std::vector<std::string> neighbours, before;
  const std::map<std::string, AssembleOptions::Fill> fills{{"prisms", AssembleOptions::Fill::prisms},
                                                           {"none", AssembleOptions::Fill::none}};
  const std::map<std::string, AssembleOptions::Exchange> exchanges{{"quads", AssembleOptions::Exchange::quads},
                                                                   {"none", AssembleOptions::Exchange::none}};
  std::string conformity = "pyramids", exchange = "quads", fill = "prisms";
  const CLI::Option *exchange_option = nullptr, *fill_option = nullptr;
  int smooth = AssembleOptions{}.smooth;
  auto declare = [&](CLI::App& app) {
    app.add_option("--conformity", conformity,
                   "pyramids: every quad gets a cell on its other side; none: quads may face two triangles")
        ->check(CLI::IsMember(conformities))
        ->capture_default_str();
    exchange_option =
        app.add_option("--exchange", exchange,
                       "quads: chosen hexes give way to other candidates by volume and quality, less a price for each "
                       "quad that faces tets; none: the choice stays, as always with --conformity none and with "
                       "--neighbours")
            ->check(CLI::IsMember(exchanges))
            ->capture_default_str();
    fill_option = app.add_option("--fill", fill,
                                 "prisms: tets between the cells become prisms where these close as many quads as they "
                                 "open; none: they stay, as always with --conformity none and with --neighbours")
                      ->check(CLI::IsMember(fills))
                      ->capture_default_str();
    app.add_option(
           "--smooth", smooth,
           "rounds of moving vertices and exchanging tets to make the worst cells better and hexes larger; 0: none")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    app.add_option("--neighbours", neighbours,
                   "With a part of a mesh: bundles of the other parts' solutions, of which those beside it are read")
        ->type_name("FILE");
    app.add_option("--before", before, "With --neighbours: the pieces that the round before made")->type_name("FILE");
  };
  auto run = [&](RunContext& context) {
    const bool by_part = !neighbours.empty();
    const bool may_change_cells = !by_part && conformity == "pyramids";
    if (!may_change_cells && exchange_option->count() > 0 && exchange == "quads")
      throw UsageError("--exchange quads goes with --conformity pyramids, without --neighbours");
    if (!may_change_cells && fill_option->count() > 0 && fill == "prisms")
      throw UsageError("--fill prisms goes with --conformity pyramids, without --neighbours");
    if (!may_change_cells) exchange = fill = "none";
    const AssembleOptions options{.conformity = conformities.at(conformity),
                                  .exchange = exchanges.at(exchange),
                                  .fill = fills.at(fill),
                                  .smooth = smooth};
    context.options["conformity"] = conformity;
    context.options["exchange"] = exchange;
    context.options["fill"] = fill;
    context.options["smooth"] = smooth;
    if (by_part && options.conformity == AssembleOptions::Conformity::none)
      throw UsageError("--conformity none does not go with --neighbours: pieces fit because they conform");
    if (!by_part && !before.empty()) throw UsageError("--before goes with --neighbours");
    pipeline::Stage stage(context);
    stage.take_part();
    if (by_part) {
      for (const Role role : {Role::mesh, Role::candidates, Role::graph, Role::solution}) stage.hold_back(role);
    } else {
      stage.take_weights();  // for the gap: which cells cannot stand together is told by their tets
    }
    pipeline::StageData data = stage.read({Role::mesh, Role::candidates, Role::solution});
    const choice::InputNames names{.mesh = stage.source_of(Role::mesh),
                                   .candidates = stage.source_of(Role::candidates),
                                   .solution = stage.source_of(Role::solution)};
    const bool graph_of_bundle = !context.streams.files.contains(Role::graph);
    const auto choice = graph_of_bundle ? proven_gap(data) : nullptr;
    const PartResult result =
        by_part ? assemble_part(pieces::view_part(solved_part(std::move(data), names), neighbours, names.solution),
                                before, options, names)
                : assemble_whole(std::move(data), options, names);
    context.statistics = to_json(result.statistics);
    for (const auto& line : summary_lines(result.statistics)) context.note(line);
    nlohmann::ordered_json details{{"counts", context.statistics["cells"]}};
    if (!choice.is_null()) {
      context.statistics["choice"] = details["choice"] = choice;
      context.note(fmt::format("the choice weighs {}, at most {} is possible: gap {:.4f} %",
                               choice["weight"].get<std::int64_t>(), choice["bound"].get<std::int64_t>(),
                               100 * choice["gap"].get<double>()));
    }
    if (by_part)
      context.note(result.piece.settled ? "this piece is settled"
                                        : "this piece has something new to say: another round has to follow");
    stage.write(result.mesh, by_part ? &result.piece : nullptr, details);
  };
  return tool_main(argc, argv, info, declare, run);
}
