#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/mesh/mesh_measures.hpp"
#include "common/mwis/ground/target_weight.hpp"
#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/tool_main.hpp"
#include "formats/meshes/mesh_files.hpp"
#include "formats/pipeline/quads_of_choice.hpp"
#include "formats/pipeline/stage.hpp"
#include "formats/pipeline/surface_file.hpp"
#include "tools/assemble/assemble.hpp"
#include "tools/assemble/options.hpp"
#include "tools/assemble/order/second_order.hpp"
#include "tools/assemble/requirements.hpp"

using namespace hexpipe;
using namespace hexpipe::assemble;

namespace {

const std::map<std::string, AssembleOptions::Conformity> conformities{
    {"pyramids", AssembleOptions::Conformity::pyramids}, {"none", AssembleOptions::Conformity::none}};
const std::map<std::string, AssembleOptions::Exchange> exchanges{{"quads", AssembleOptions::Exchange::quads},
                                                                 {"none", AssembleOptions::Exchange::none}};
const std::map<std::string, AssembleOptions::Fill> fills{{"prisms", AssembleOptions::Fill::prisms},
                                                         {"none", AssembleOptions::Fill::none}};
const std::map<std::string, AssembleOptions::Merge> merges{{"vertices", AssembleOptions::Merge::vertices},
                                                           {"none", AssembleOptions::Merge::none}};
const std::map<std::string, AssembleOptions::Mend> mends{{"quality", AssembleOptions::Mend::quality},
                                                         {"finite-volumes", AssembleOptions::Mend::finite_volumes}};

struct CommandLine {
  std::string conformity = "pyramids", exchange = "quads", fill = "prisms", merge = "vertices", mend;
  const CLI::Option *exchange_option = nullptr, *fill_option = nullptr, *merge_option = nullptr;
  int smooth = AssembleOptions{}.smooth;
  std::string walls;
  const CLI::Option *walls_option = nullptr, *height_option = nullptr, *growth_option = nullptr;
  double first_height = 0, growth = LayerOptions{}.growth;
  bool pillow = false;
  std::string require;
  std::vector<std::string> neighbours, before;
  int order = 1;
  std::string nodes = "serendipity", surface;
  const CLI::Option *nodes_option = nullptr, *surface_option = nullptr;

  bool by_part() const { return !neighbours.empty(); }
};

void declare_options(CLI::App& app, CommandLine& line) {
  begin_group(app, "Cells");
  app.add_option("--conformity", line.conformity,
                 "pyramids: every quad has a cell on its other side; none: quads may face two triangles")
      ->check(one_of(conformities))
      ->capture_default_str();
  line.exchange_option =
      app.add_option("--exchange", line.exchange,
                     "quads: exchanges chosen hexes for other candidates, by volume and quality, less a cost for each "
                     "quad that faces tets; none: keeps the choice. none always holds with --conformity none and with "
                     "--neighbours, and is the default for a graph of buildgraph --quad-reward")
          ->check(one_of(exchanges))
          ->capture_default_str();
  line.fill_option =
      app.add_option("--fill", line.fill,
                     "prisms: makes prisms of tets between the cells where they close at least as many quads as they "
                     "open; none: keeps the tets. none always holds with --conformity none and with --neighbours")
          ->check(one_of(fills))
          ->capture_default_str();
  line.merge_option =
      app.add_option(
             "--merge", line.merge,
             "vertices: vertices that no hex uses merge, and rooms between the hexes are filled anew, where "
             "this leaves fewer or better cells; none: keeps them. none always holds with --conformity none and "
             "with --smooth 0")
          ->check(one_of(merges))
          ->capture_default_str();
  app.add_option("--mend", line.mend,
                 "quality: the worst cells between the hexes become better at the end; finite-volumes: then what "
                 "OpenFOAM's checkMesh counts as wrong is mended, too, for a few more cells. Goes with --merge "
                 "vertices [finite-volumes with --solver openfoam or for a polyMesh, otherwise quality]")
      ->check(one_of(mends));
  app.add_option("--smooth", line.smooth,
                 "Rounds of moving vertices and flipping tets to make the worst cells better and hexes larger; 0: none")
      ->group(group::first)
      ->check(whole_number_between(0, 1000))
      ->capture_default_str();
  outside_history(
      app.add_option(
          "--require", line.require,
          "Limits that the result must keep, such as 'hexes 0.3, cells 0.1, orthogonality 70, weight 0.05, determinant "
          "0.001, flatness 0.8': the scaled Jacobian of hexes, that of all cells, and what finite volumes need "
          "(docs/definitions.md); if it does not, nothing is written, and a message names the place"))
      ->type_name("LIST");
  begin_group(app, "Second order");
  app.add_option("--order", line.order,
                 "2: elements have nodes in the middles of their edges, which bend with the surface, as far as the "
                 "Jacobian is shown to be positive everywhere; 1: straight edges, corners alone")
      ->check(whole_number_between(1, 2))
      ->capture_default_str();
  line.nodes_option = app.add_option("--nodes", line.nodes,
                                     "With --order 2, serendipity: nodes on edges (hexes of 20); full: in the middles "
                                     "of quads and hexes, too (hexes of 27)")
                          ->check(one_of({"serendipity", "full"}))
                          ->capture_default_str();
  line.surface_option =
      outside_history(
          app.add_option("--surface", line.surface,
                         "With --order 2: the surface that the mesh was made of, in any format of tetmesh; nodes of "
                         "the boundary go onto it [that of the bundle; without one, arcs through the vertices]"))
          ->type_name("FILE");
  begin_group(app, "Layers at walls");
  line.walls_option =
      app.add_option("--boundary-layers", line.walls,
                     "Layers of hexes and prisms on surfaces, by name or number, such as 'wall=5, 3=5'; "
                     "all=5: on all of the boundary; 'wall in water=5': on one side of an interface; 'all in water=5': "
                     "on all that "
                     "bounds the region, interfaces too; 1 to 100 layers")
          ->type_name("LIST");
  line.height_option =
      app.add_option("--first-height", line.first_height,
                     "With --boundary-layers, which needs it: the height of the layer at the wall, in units "
                     "of the mesh; where there is no room, all layers are lower in proportion")
          ->check(number_between(1e-50, 1e50))
          ->default_str("");
  line.growth_option =
      app.add_option("--growth", line.growth,
                     "Each layer is this many times as high as the one before it, seen from the wall (0.1 to 10)")
          ->check(number_between(0.1, 10))
          ->capture_default_str();
  app.add_flag(
      "--pillow", line.pillow,
      "One layer on all of the boundary, behind those of --boundary-layers, half as high as the wall's edges are "
      "long; then --smooth rounds of smoothing");
  begin_group(app, "In parts");
  outside_history(
      app.add_option(
          "--neighbours", line.neighbours,
          "With a part of a mesh: bundles of the other parts' solutions; reads those of the parts beside it"))
      ->type_name("FILE");
  outside_history(app.add_option("--before", line.before, "With --neighbours: the pieces of the previous round"))
      ->type_name("FILE");
}

// Checks that involve several options.
AssembleOptions options_of(CommandLine& line, bool for_openfoam) {
  const bool may_change_cells = !line.by_part() && line.conformity == "pyramids";
  if (!may_change_cells && line.exchange_option->count() > 0 && line.exchange == "quads")
    throw UsageError("--exchange quads goes with --conformity pyramids, without --neighbours");
  if (!may_change_cells && line.fill_option->count() > 0 && line.fill == "prisms")
    throw UsageError("--fill prisms goes with --conformity pyramids, without --neighbours");
  if (!may_change_cells) line.exchange = line.fill = "none";
  const bool may_merge = line.conformity == "pyramids" && line.smooth > 0;
  if (!may_merge && line.merge_option->count() > 0 && line.merge == "vertices")
    throw UsageError("--merge vertices goes with --conformity pyramids, and with --smooth of 1 or more");
  if (!may_merge) line.merge = "none";
  const bool has_merges = line.merge == "vertices";
  if (line.mend.empty()) line.mend = for_openfoam && has_merges ? "finite-volumes" : "quality";
  if (!has_merges && line.mend == "finite-volumes")
    throw UsageError("--mend finite-volumes goes with --merge vertices");
  if (line.by_part() && line.conformity == "none")
    throw UsageError("--conformity none does not go with --neighbours: pieces fit because they conform");
  if (line.by_part() && !line.require.empty())
    throw UsageError("--require does not go with --neighbours: on the seam of a piece cells have no neighbours");
  if (line.by_part() && line.order == 2)
    throw UsageError("--order 2 does not go with --neighbours: pieces are of first order");
  if (line.order == 1 && line.nodes_option->count() > 0) throw UsageError("--nodes goes with --order 2");
  if (line.order == 1 && line.surface_option->count() > 0) throw UsageError("--surface goes with --order 2");
  if (line.surface == "-") throw UsageError("--surface takes a file, found '-': the mesh comes from standard input");
  if (!line.by_part() && !line.before.empty()) throw UsageError("--before goes with --neighbours");
  return {.conformity = conformities.at(line.conformity),
          .exchange = exchanges.at(line.exchange),
          .fill = fills.at(line.fill),
          .merge = merges.at(line.merge),
          .mend = mends.at(line.mend),
          .smooth = line.smooth};
}

// Layers that differ more than this are a slip.
void check_growth(const layers::AskedWall& wall, double growth) {
  constexpr double most = 1e6;
  const double ratio = std::pow(growth, wall.layers - 1);
  if (!(ratio <= most && ratio >= 1 / most))
    throw UsageError(
        fmt::format("--growth: expected layers of heights that differ by a factor of at most {:g}, found {:.2g} for {} "
                    "layers on '{}'",
                    most, std::max(ratio, 1 / ratio), wall.layers, wall.name));
}

LayerOptions layer_options_of(const CommandLine& line) {
  const bool has_walls = line.walls_option->count() > 0;
  if ((has_walls || line.pillow) && (line.by_part() || line.conformity == "none"))
    throw UsageError("--boundary-layers and --pillow go with --conformity pyramids, without --neighbours");
  if (has_walls && line.height_option->count() == 0) throw UsageError("--boundary-layers goes with --first-height");
  if (!has_walls && line.height_option->count() + line.growth_option->count() > 0)
    throw UsageError("--first-height and --growth go with --boundary-layers");
  LayerOptions options{.first_height = line.first_height, .growth = line.growth, .pillow = line.pillow};
  if (has_walls) options.walls = layers::parse_walls(line.walls);
  for (const layers::AskedWall& wall : options.walls) check_growth(wall, line.growth);
  return options;
}

pipeline::StageData read_input(pipeline::Stage& stage, const CommandLine& line) {
  pipeline::StageRequest request{.needs = {Role::mesh, Role::candidates, Role::solution},
                                 .surface = line.order == 2 && line.surface.empty(),
                                 .part = true};
  if (line.by_part())
    request.hold_back = {Role::mesh, Role::candidates, Role::graph, Role::solution};
  else
    request.weights_only = true;  // for the gap: tets tell which cells do not fit together
  return stage.read(request);
}

// The weight of the choice beside the best possible one, if certify has proven a bound for its graph.
nlohmann::ordered_json proven_gap(const pipeline::StageData& data) {
  const auto bound = mwis::ground::bound_in(data.history);
  if (!data.graph || !bound) return nullptr;
  const std::int64_t of_quads = pipeline::weight_of_quads(data);
  const std::int64_t weight = graph::total_weight(*data.solution, *data.graph) - of_quads, most = *bound - of_quads;
  return {{"weight", weight}, {"bound", most}, {"gap", mwis::ground::gap_to(most, weight)}};
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

PartResult assemble_whole(pipeline::StageData data, const AssembleOptions& options, LayerOptions layers,
                          const choice::InputNames& names) {
  layers.tag_names = {data.names.surfaces, data.names.regions};
  if (data.part && !data.part->neighbours.empty())
    throw DataError::at(names.mesh, "expected the neighbours of {} with --neighbours, found none",
                        title_of(*data.part));
  AssembleResult result =
      assemble::assemble(std::move(*data.mesh), *data.candidates, *data.solution, options, names, layers);
  return {std::move(result.mesh), std::move(result.statistics), {}};
}

PartResult assemble_one_part(pipeline::StageData data, const CommandLine& line, const AssembleOptions& options,
                             const choice::InputNames& names) {
  pieces::PartView view = pieces::view_part(solved_part(std::move(data), names), line.neighbours, names.solution);
  return assemble_part(std::move(view), line.before, build_rules(options), names);
}

// Notes what a user wants to know, and returns the details for the history.
nlohmann::ordered_json report(RunContext& context, const AssembleStatistics& statistics,
                              const nlohmann::ordered_json& choice) {
  context.statistics = to_json(statistics);
  for (const auto& line : summary_lines(statistics)) context.note(line);
  if (const auto warning = pillow_warning(statistics)) context.warn(*warning);
  if (const auto warning = layers_warning(statistics)) context.warn(*warning);
  nlohmann::ordered_json details{{"counts", context.statistics["cells"]}};
  if (choice.is_null()) return details;
  context.statistics["choice"] = details["choice"] = choice;
  context.note(fmt::format("the choice weighs {}, at most {} is possible: gap {:.4f} %",
                           choice["weight"].get<std::int64_t>(), choice["bound"].get<std::int64_t>(),
                           100 * choice["gap"].get<double>()));
  return details;
}

order::SecondOrderCounts add_second_order(const CommandLine& line, std::optional<formats::SurfaceSoup> soup,
                                          PartResult& result) {
  std::optional<order::GivenSurface> surface;
  order::FitCounts corners;
  if (soup) {
    surface.emplace(*std::move(soup));
    corners = order::fit_corners(result.mesh, *surface);
    count_cells(result.mesh, result.statistics);
    result.statistics.measures = measure_mesh(result.mesh);
  }
  auto counts = order::make_second_order(result.mesh, line.nodes == "full", surface ? &*surface : nullptr);
  counts.corners = corners;
  return counts;
}

// Returns the details for the history.
nlohmann::ordered_json report_second_order(RunContext& context, const order::SecondOrderCounts& counts) {
  context.note(order::summary_line(counts));
  const curved::BendCounts& bending = counts.bending;
  if (!counts.has_surface)
    context.warn("no surface was given: nodes of the boundary lie on arcs through its vertices; --surface names it");
  if (counts.corners.held > 0)
    context.warn(
        fmt::format("{} vertices of the boundary stay off the surface: it is further than a tenth of an edge away, or "
                    "cells would lose quality",
                    counts.corners.held));
  if (counts.strays > 0)
    context.warn(
        fmt::format("{} of {} nodes of the boundary have no place on the surface near them, and lie on arcs "
                    "through its vertices",
                    counts.strays, bending.on_boundary));
  if (!bending.drawn_back.empty())
    context.warn(
        fmt::format("{} of {} nodes of the boundary stay up to {:.3g} off the surface, {} of them on the "
                    "chord, because cells would be bent too much",
                    bending.drawn_back.size(), bending.on_boundary, bending.farthest, bending.straight));
  return context.statistics["second_order"] = order::to_json(counts);
}

bool is_for_openfoam(const RunContext& context, const pipeline::Stage& stage) {
  return context.streams.mesh.solver == "openfoam" || stage.format() == formats::poly_mesh_format;
}

void run(RunContext& context, CommandLine& line) {
  pipeline::Stage stage(context);
  AssembleOptions options = options_of(line, is_for_openfoam(context, stage));
  LayerOptions layers = layer_options_of(line);
  const auto requirements = line.require.empty() ? std::vector<Requirement>{} : parse_requirements(line.require);
  context.options["conformity"] = line.conformity;
  context.options["exchange"] = line.exchange;
  context.options["fill"] = line.fill;
  context.options["merge"] = line.merge;
  context.options["mend"] = line.mend;
  context.options["smooth"] = line.smooth;
  if (line.order == 2) context.options["order"] = line.order, context.options["nodes"] = line.nodes;
  if (!line.walls.empty()) {
    context.options["boundary_layers"] = line.walls;
    context.options["first_height"] = line.first_height;
    context.options["growth"] = line.growth;
  }
  if (line.pillow) context.options["pillow"] = true;
  if (line.order == 2) stage.expect_second_order(line.nodes == "full");
  std::optional<formats::SurfaceSoup> surface;
  if (!line.surface.empty()) surface = pipeline::read_surface_file(line.surface);
  pipeline::StageData data = read_input(stage, line);
  if (!surface) surface = std::exchange(data.surface, std::nullopt);
  const choice::InputNames names{.mesh = stage.source_of(Role::mesh),
                                 .candidates = stage.source_of(Role::candidates),
                                 .solution = stage.source_of(Role::solution)};
  const bool graph_of_bundle = !context.streams.files.contains(Role::graph);
  const auto choice = graph_of_bundle ? proven_gap(data) : nullptr;
  const bool chosen_with_quads = data.quads && line.exchange_option->count() == 0;
  if (chosen_with_quads) options.exchange = AssembleOptions::Exchange::none;
  pipeline::drop_quads(data);
  PartResult result = line.by_part() ? assemble_one_part(std::move(data), line, options, names)
                                     : assemble_whole(std::move(data), options, std::move(layers), names);
  std::optional<order::SecondOrderCounts> second_order;
  if (line.order == 2) second_order = add_second_order(line, std::move(surface), result);
  auto details = report(context, result.statistics, choice);
  // The stage has had the options of the command line.
  if (chosen_with_quads) {
    context.options["exchange"] = "none";
    details["options"] = context.options;
  }
  if (line.by_part())
    context.note(result.piece.settled ? "this piece is settled"
                                      : "this piece has something new to say: another round has to follow");
  check_requirements(result.mesh, requirements);
  if (second_order) details["second_order"] = report_second_order(context, *second_order);
  pipeline::ResultProduct product{.mesh = std::move(result.mesh)};
  if (line.by_part()) product.piece = std::move(result.piece);
  stage.write(product, details);
}

}  // namespace

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "assemble",
      .summary = "Build the hex-dominant mesh from the chosen candidates and the tets that remain.",
      .example = "tetmesh bracket.stl --size 3 | findhex | buildgraph | initsol | assemble -v -o bracket.vtu",
      .reads = {Role::mesh, Role::candidates, Role::graph, Role::solution},
      .product = Role::result,
  };
  CommandLine line;
  return tool_main(
      argc, argv, info, [&](CLI::App& app) { declare_options(app, line); },
      [&](RunContext& context) { run(context, line); });
}
