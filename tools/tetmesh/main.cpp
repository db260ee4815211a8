#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "common/run/memory.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/stage.hpp"
#include "formats/points/point_files.hpp"
#include "formats/points/size_files.hpp"
#include "formats/surfaces/surface_soup.hpp"
#include "tools/tetmesh/options.hpp"
#include "tools/tetmesh/tetmesh.hpp"

using namespace hexpipe;
using namespace hexpipe::tetmesh;

namespace {

const std::map<std::string, SurfaceKind> surface_kinds{{"remesh", SurfaceKind::remesh}, {"keep", SurfaceKind::keep}};
const std::map<std::string, PointKind> point_kinds{
    {"best", PointKind::best}, {"frame", PointKind::frame}, {"lattice", PointKind::lattice}, {"none", PointKind::none}};
const std::map<std::string, solid::ShellRule> shell_rules{{"oriented", solid::ShellRule::oriented},
                                                          {"regions", solid::ShellRule::regions},
                                                          {"holes", solid::ShellRule::holes}};

formats::Input open_surface(const std::string& path) {
  if (path == "-" && isatty(STDIN_FILENO))
    throw UsageError("nothing to read: name a surface, or pipe one to standard input (see tetmesh --help)");
  return formats::Input::open(path);
}

// Reads "3" as the size everywhere; for other texts see asked_sizes.hpp.
void add_size(const std::string& text, TetmeshOptions& options) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos && options.sizes.size)
    throw UsageError(fmt::format("expected one --size for the whole model, found a second one: '{}'", text));
  if (equals == std::string::npos)
    options.sizes.size = sizing::parse_length(text);
  else
    options.asked_sizes.push_back(parse_asked_size(text));
}

// Files alone are scaled: a bundle passes its surface on as it is.
void scale_surface(double factor, formats::SurfaceSoup& surface) {
  if (surface.from_bundle)
    throw DataError::at(surface.name,
                        "expected a surface file for --scale, found a bundle; tessellate --unit scales CAD");
  for (Vec3& p : surface.points) p = factor * p;
  formats::check_extent(surface);
}

void choose_points(const std::string& points, TetmeshOptions& options) {
  const auto kind = point_kinds.find(points);
  options.points = kind == point_kinds.end() ? PointKind::given : kind->second;
  if (options.points != PointKind::given) return;
  if (!std::filesystem::exists(points))
    throw UsageError(fmt::format("expected --points best, frame, lattice, none or a file, found '{}'", points));
  formats::Input input = formats::Input::open(points);
  options.given_points = formats::read_points(input);
  if (options.given_points.points.empty()) throw DataError::at(input.name(), "expected points, found none");
}

sizing::SizeSources size_sources(const std::string& path, const formats::SurfaceSoup& surface) {
  formats::Input input = formats::Input::open(path);
  formats::SizeList list = formats::on_surface(formats::read_sizes(input), surface);
  return {std::move(list.points), std::move(list.sizes), std::move(list.simplices), {}};
}

std::string summary(const TetmeshStatistics& s) {
  return fmt::format(
      "{} points ({} of the surface, {} inside), {} tets, volume {:.6g}, size {:.4g}, dihedral angles {:.3g} to {:.4g} "
      "degrees",
      s.points, s.surface_points, s.points - s.surface_points, s.tets, s.volume, s.size, s.least_dihedral,
      s.greatest_dihedral);
}

}  // namespace

int main(int argc, char** argv) {
  const ToolInfo info{
      .name = "tetmesh",
      .summary = "Fill a closed surface (STL, OBJ, PLY, OFF, 3MF, bundle) with tetrahedra that merge well into hexes.",
      .example = "tetmesh bracket.stl --size 3 | findhex | buildgraph | initsol | assemble -o bracket.vtu",
      .reads = {},
      .product = Role::mesh,
      .random = true,
      .licence = "AGPL-3.0, because it links TetGen"};
  TetmeshOptions options;
  const CLI::App* command_line = nullptr;
  std::optional<std::string> size_file, least_size;
  std::optional<double> scale;
  std::vector<std::string> given_sizes;
  std::vector<std::string> tag_names;
  std::string path = "-", surface_kind = "remesh", points = "best", shells = "oriented", weld = "0.0001%";
  bool keeps_baffles = false;
  const auto declare = [&](CLI::App& app) {
    command_line = &app;
    app.add_option("input", path, "A surface in any format; '-' or nothing: standard input")->type_name("FILE");
    app.add_option(
           "--size", given_sizes,
           "Distance of points inside, in the surface's units or, with %, in percent of the bounding box's diagonal "
           "[a size that suits the model]; inlet=0.5 is the size at a surface, 'body bolt=1' in a body, 'box "
           "0,0,0,1,1,1=0.2' in a box")
        ->allow_extra_args(false)
        ->type_name("LENGTH");
    begin_group(app, "Sizes");
    app.add_option(
           "--size-field", size_file,
           "Sizes by place: lines of x y z size, or one size for each vertex of the surface, or either of them in "
           ".npy, or a background mesh in .msh with $NodeData")
        ->type_name("FILE");
    app.add_option("--scale", scale,
                   "Multiply the coordinates of a surface file by this; all lengths are in the new unit")
        ->group("Surface")
        ->check(number_between(1e-12, 1e12))
        ->type_name("FACTOR");
    app.add_option("--grading", options.sizes.grading,
                   "How much sizes may differ between two places, as a share of their distance")
        ->check(number_between(0.01, 10));
    app.add_option("--curvature", options.sizes.curvature,
                   "If given: where the surface bends, elements span at most an Nth of a turn")
        ->check(number_between(3, 1000))
        ->type_name("N");
    app.add_option("--least-size", least_size,
                   "With --curvature: the least size that bends ask for [a fifth of --size]")
        ->type_name("LENGTH");
    app.add_option("--layers", options.sizes.layers,
                   "If given: thin walls get at least N elements across (2 without N)")
        ->expected(0, 1)
        ->default_str("2")
        ->check(whole_number_between(1, 100))
        ->type_name("[N]");
    begin_group(app, "Surface");
    app.add_option("--surface", surface_kind, "The surface's triangles: made anew to suit hexes, or kept")
        ->check(one_of(surface_kinds));
    app.add_option(
           "--feature-angle", options.feature_angle,
           "Edges where the surface turns by more than this, in degrees, are kept, and corners where they turn by more")
        ->check(number_between(1, 180));
    app.add_option(
           "--deviation", options.deviation,
           "How far the new surface may be from the old one, in sizes; in walls thinner than a size, in thicknesses")
        ->check(number_between(1e-6, 1));
    app.add_option("--short-features", options.short_features,
                   "Features shorter or narrower than this, in sizes, go, and the poor cells at them; 0: none")
        ->check(number_between(0, 0.2));
    app.add_option(
           "--stretch", options.row_stretch,
           "How much rows of points may stretch so that fewer end on faces: from one triangle of the field to the "
           "next, in sizes; 0: not at all")
        ->check(number_between(0, 10));
    begin_group(app, "Points inside");
    app.add_option("--points", points,
                   "Points inside: best, frame (along a frame field that follows the surface), lattice (along the "
                   "model's own axes), none, or a file of your own (.xyz, .node, .npy, .ply)")
        ->type_name("KIND:{best,frame,lattice,none}|FILE");
    app.add_option(
           "--clearance", options.clearance,
           "Least distance of points inside from the surface, in sizes; more where tets at the surface come out "
           "flat, less where a thin wall stays without points")
        ->group(group::experts)
        ->check(number_between(0.1, 10));
    app.add_option("--jitter", options.jitter,
                   "How far points inside are moved at random along each axis, in sizes [0.04; on a lattice 0.01]")
        ->check(number_between(0, 1));
    app.add_option("--most-points", options.most_points,
                   "Most points inside, to protect memory; more for a mesh that has to be that large")
        ->group(group::experts)
        ->check(number_between(1, 1e9));
    app.add_option(
           "--tries", options.tries,
           "How many sizes to try, up to 5 % off; the mesh that is estimated to have most hexes is kept [1; 3 of "
           "tetmesh's own size, or less where nearly all becomes hexes]")
        ->check(whole_number_between(1, most_tries));
    app.add_option("--improve", options.improve,
                   "Rounds of a search that moves, adds and removes points where that brings hexes; a round "
                   "takes five runs of TetGen")
        ->group(group::first)
        ->type_name("ROUNDS")
        ->check(whole_number_between(0, 1000000).description(""));
    app.add_option("--time-limit", options.time_limit, "With --improve: stop the search after this many seconds")
        ->type_name("SECONDS")
        ->check(number_between(0, 1e9));
    begin_group(app, "Faults, bodies and names");
    CLI::Option* const repair = app.add_flag(
        "--repair", options.repair,
        "Weld points, remove flat and repeated triangles, turn triangles that disagree with their neighbours, fill "
        "small holes, make triangles anew where few intersect");
    app.add_flag(
           "!--strict", options.mend,
           "Refuse a surface with any fault. Without it, those that change no shape are mended with a warning: "
           "triangles without area, copies and strays, points that differ by rounding or lie on an edge, few triangles "
           "that intersect")
        ->excludes(repair);
    CLI::Option* const unite = app.add_flag("--unite", options.unite, "Make one body of bodies that overlap");
    app.add_flag("--keep-baffles", keeps_baffles,
                 "Keep sheets inside, with the same region on both sides; without it, they are left out")
        ->excludes(repair)
        ->excludes(unite);
    app.add_option("--weld", weld,
                   "With --repair: points this near to each other become one; a length, or with % of the diagonal")
        ->type_name("LENGTH")
        ->capture_default_str();
    app.add_option("--largest-hole", options.largest_hole, "With --repair: most edges of a hole that is filled")
        ->check(whole_number_between(0, 1000));
    app.add_option("--shells", shells,
                   "Shells inside shells: holes if they point inward and regions otherwise; all regions; or holes and "
                   "regions in "
                   "turn")
        ->check(one_of(shell_rules));
    app.add_option("--tags-by-angle", options.tag_angle,
                   "If given: smooth parts of the surface without a name get tags of their own; they end at edges that "
                   "turn by more "
                   "than this many degrees (40 without ANGLE)")
        ->expected(0, 1)
        ->default_str("40")
        ->check(number_between(1, 180))
        ->type_name("[ANGLE]");
    app.add_option("--name", tag_names, "Name a surface or a region by its tag: 3=inlet, 'region 1=steel'; repeatable")
        ->allow_extra_args(false)
        ->type_name("TAG=NAME");
    outside_history(app.add_option("--tetgen-timeout", options.tetgen_timeout,
                                   "Seconds after which TetGen is given up, for each mesh that it makes; more where a "
                                   "large mesh needs it"))
        ->group(group::experts)
        ->check(number_between(0.001, 1e9));
  };
  const auto run = [&](RunContext& context) {
    for (const std::string& text : given_sizes) add_size(text, options);
    if (least_size) options.sizes.least = sizing::parse_length(*least_size);
    options.surface = surface_kinds.at(surface_kind);
    choose_points(points, options);
    refuse_idle_options([&](const char* name) { return command_line->count(name) > 0; }, options, points);
    options.shells = shell_rules.at(shells);
    if (keeps_baffles) options.baffles = solid::BaffleRule::keep;
    for (const std::string& text : tag_names) options.tag_names.push_back(solid::parse_tag_name(text));
    options.seed = context.common.seed;
    options.weld = sizing::parse_length(weld);
    pipeline::Stage stage(context);
    formats::Input input = open_surface(path);
    formats::SurfaceSoup surface = stage.read_surface(input);
    if (scale) scale_surface(*scale, surface);
    if (size_file) options.sizes.sources = size_sources(*size_file, surface);
    TetmeshResult result = tetmesh::tetmesh(std::move(surface), options);
    if (const auto& repair = result.statistics.repair; repair && repair->anything())
      context.warn(options.repair ? fmt::format("{}: repaired: {}", input.name(), repair->sentence())
                                  : fmt::format("{}: mended: {} (see --strict)", input.name(), repair->sentence()));
    if (const auto united = result.statistics.united_bodies; united && *united > 0)
      context.warn(fmt::format("{}: united {} bodies that overlap", input.name(), *united));
    for (const std::string& warning : result.warnings) context.warn(warning);
    if (const auto& improved = result.statistics.improved)
      context.note(fmt::format("{} changes in {} rounds: about {:.1f} % in hexes, in place of {:.1f}",
                               improved->changes, improved->rounds, 100 * improved->share,
                               100 * improved->share_before));
    context.note(summary(result.statistics));
    context.statistics.update(to_json(result.statistics));
    context.statistics["seconds_by_step"] = times_of(result.statistics);
    context.statistics["tetgen_seconds"] = result.statistics.seconds.of_tetgen;
    stage.set_names(result.names);
    pipeline::MeshProduct product{std::move(result.mesh)};
    product.dislocations = std::move(result.dislocations);
    stage.write(product, to_json(result.statistics));
  };
  // For its many steps, each with arrays of its own. Other tools gain nothing, and buildgraph takes a fifth more
  // memory.
  reuse_freed_memory();
  std::vector<char*> words = words_for_parsing(argc, argv);
  return tool_main(argc, words.data(), info, declare, run);
}
