#include "tools/tetmesh/tetmesh.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "common/mesh/box_tree.hpp"
#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/progress.hpp"
#include "tools/tetmesh/asked_sizes.hpp"
#include "tools/tetmesh/improve.hpp"
#include "tools/tetmesh/meshing.hpp"
#include "tools/tetmesh/solid/body_union.hpp"
#include "tools/tetmesh/solid/borders.hpp"
#include "tools/tetmesh/solid/flat_triangles.hpp"
#include "tools/tetmesh/solid/repair_steps.hpp"
#include "tools/tetmesh/solid/sheets.hpp"
#include "tools/tetmesh/tetgen/build_mesh.hpp"
#include "tools/tetmesh/tetgen/numbering.hpp"
#include "tools/tetmesh/volume/estimates.hpp"

namespace hexpipe::tetmesh {
namespace {

// The sizes that are tried, in this order, as factors of the size asked for. The number of whole cells across a model
// changes with the size, and so does the share of hexes, by several percent and in no particular order.
constexpr std::array<double, most_tries> tried_sizes{1, 0.95, 0.975, 1.05, 1.025, 0.9625, 1.0375, 0.9875, 1.0125};

// So many sizes are tried where the user asks for none, until this share of the volume is likely to become hexes:
// beyond it there is little to gain. Large meshes, by the points expected inside, are made once, because each try takes
// as long as the first.
constexpr std::size_t tries_of_own_size = 3;
constexpr double enough_hexes = 0.96, most_points_to_try_again = 20000;

struct Tries {
  std::size_t most = 1;
  double enough = 1;  // share of the volume in hexes after which no other size is tried
};

// Sizes that are asked for are not changed.
bool chooses_size(const TetmeshOptions& o) {
  return o.surface == SurfaceKind::remesh && places_points(o.points) && !o.sizes.size && o.sizes.sources.empty() &&
         !o.sizes.curvature && !o.sizes.layers && o.asked_sizes.empty();
}

Tries tries_of(const solid::Surface& surface, const TetmeshOptions& options, double size) {
  if (options.tries) return {.most = *options.tries};
  if (!chooses_size(options) || sizing::points_expected(surface, size) > most_points_to_try_again) return {};
  return {.most = tries_of_own_size, .enough = enough_hexes};
}

MeshedSurface mesh_at(double factor, const solid::Surface& surface, const sizing::SizeDemand& demand,
                      const sizing::SizeField& size, const MeshingOptions& options) {
  if (factor == 1) return mesh_surface(surface, demand, size, options);
  const sizing::SizeDemand scaled = factor * demand;
  return mesh_surface(surface, scaled, sizing::field_of(surface, scaled), options);
}

// Keeps the mesh that is estimated to have most hexes. A size at which TetGen fails is passed over, unless it fails at
// all sizes.
MeshedSurface best_of_tries(const solid::Surface& surface, const sizing::SizeDemand& demand,
                            const sizing::SizeField& size, const Tries& tries, const MeshingOptions& options) {
  std::optional<MeshedSurface> best;
  std::vector<TriedSize> tried;
  StepSeconds seconds;
  std::exception_ptr failure;
  std::size_t number = 0;
  for (const double factor : std::span(tried_sizes).first(tries.most)) {
    const auto share = [&](std::size_t done) { return static_cast<double>(done) / static_cast<double>(tries.most); };
    const Step step(nullptr, share(number), share(number + 1));
    ++number;
    try {
      MeshedSurface meshed = mesh_at(factor, surface, demand, size, options);
      const TetmeshStatistics& statistics = meshed.statistics;
      tried.push_back({statistics.size, statistics.hex_share});
      seconds += statistics.seconds;
      if (!best || statistics.hex_share > best->statistics.hex_share) best = std::move(meshed);
    } catch (const tetgen::TetGenFailure&) {
      tried.push_back({factor * size.greatest(), {}});
      if (!failure) failure = std::current_exception();
    }
    if (best && best->statistics.hex_share >= tries.enough) break;
  }
  if (!best) std::rethrow_exception(failure);
  best->statistics.seconds = seconds;
  if (tries.most > 1) best->statistics.tried = std::move(tried);
  return *std::move(best);
}

// Whether the vertices stay in TetGen's order: because the user's own points are promised to keep theirs, or because
// the mesh is so small that later stages hold it in the processor's caches anyway.
bool keeps_order(const TetMesh& mesh, const TetmeshOptions& options) {
  constexpr std::size_t most_of_a_small_mesh = 10000;
  return options.surface == SurfaceKind::keep || options.points == PointKind::given ||
         mesh.points.size() <= most_of_a_small_mesh;
}

// Describes the mesh, and moves it to where it is wanted.
TetmeshResult finish(MeshedSurface meshed, const solid::Surface& given, const TetmeshOptions& options) {
  const Stopwatch watch;
  const solid::Surface& surface = meshed.surface(given);
  const tetgen::BuiltMesh& built = meshed.built;
  TetmeshStatistics& s = meshed.statistics;
  const tetgen::MeshShape shape = tetgen::shape_of(built.mesh);
  s.surface_points = surface.points.size();
  s.surface_triangles = surface.triangles.size();
  s.shells = surface.shells.size();
  s.regions = static_cast<std::size_t>(surface.region_count);
  s.points = built.mesh.points.size();
  s.tets = built.mesh.tets.size();
  s.added_points = built.added_points;
  s.dropped_points = built.dropped_points;
  s.volume = shape.volume;
  s.least_dihedral = shape.least_dihedral;
  s.greatest_dihedral = shape.greatest_dihedral;
  if (!keeps_order(built.mesh, options)) tetgen::number_along_curve(meshed.built.mesh, s.added_points);
  s.seconds.building += watch.seconds();
  return {std::move(meshed.built.mesh), given.names, std::move(s), std::move(meshed.warnings),
          std::move(meshed.dislocations)};
}

// A size in another unit than the surface's: then one cell would be larger than the model.
std::optional<std::string> complaint_about_size(const solid::Surface& surface, double size) {
  const Box box = Box::around(surface.points);
  const Vec3 extent = box.high - box.low;
  if (size <= std::max({extent.x, extent.y, extent.z})) return std::nullopt;
  return fmt::format("the size {:.6g} is larger than the model, which measures {:.6g} x {:.6g} x {:.6g}", size,
                     extent.x, extent.y, extent.z);
}

// Rounding may leave triangles without area and folds.
std::size_t unite(formats::SurfaceSoup& soup) {
  const std::size_t united = solid::unite_bodies(soup);
  if (united == 0) return united;
  solid::mend(soup);
  solid::remove_folds(soup, {.tolerance = solid::rounding_of(soup)});
  return united;
}

MeshingOptions meshing_options(const TetmeshOptions& o, bool estimates) {
  return {o.surface == SurfaceKind::remesh,
          o.feature_angle,
          o.deviation,
          o.short_features,
          o.row_stretch,
          o.points,
          o.given_points,
          o.clearance,
          o.jitter,
          o.seed,
          o.most_points,
          o.tetgen_timeout,
          estimates};
}

}  // namespace

TetmeshResult tetmesh(formats::SurfaceSoup soup, const TetmeshOptions& options) {
  check_options(options);
  const Stopwatch watch;
  std::optional<Step> step(std::in_place, "checking the surface", 0, 0.02);
  std::optional<solid::RepairReport> repaired;
  if (options.repair) repaired = solid::repair(soup, {sizing::in_units(options.weld, soup), options.largest_hole});
  if (options.mend && !options.repair) repaired = solid::mend(soup, options.baffles);
  std::size_t united = 0;
  if (options.unite) united = unite(soup);
  std::vector<std::string> warnings;
  const bool keeps_baffles = options.baffles == solid::BaffleRule::keep;
  const char* remedy = !soup.sides.empty() ? ""
                       : keeps_baffles     ? "; a baffle shares whole edges with what it meets"
                       : options.repair    ? " (see wrap)"
                                           : " (see --repair)";
  std::function<void(formats::SurfaceSoup&)> mend_folds;
  if (repaired && !options.repair && soup.sides.empty() && !keeps_baffles)
    mend_folds = [&](formats::SurfaceSoup& given) { solid::mend_folds(given, *repaired); };
  solid::Surface tagged =
      solid::boundary_of(std::move(soup), options.shells, options.baffles, remedy, warnings, mend_folds);
  const bool triangles_stay = options.surface == SurfaceKind::keep;
  if (!triangles_stay) solid::flip_flat_triangles(tagged);
  if (options.tag_angle) solid::tag_by_angle(tagged, *options.tag_angle);
  solid::name_tags(tagged, options.tag_names);
  const solid::Surface surface = std::move(tagged);
  sizing::SizeDemand demand = sizing::demand_on(surface, options.sizes, options.feature_angle, triangles_stay);
  if (auto complaint = complaint_about_size(surface, demand.greatest)) warnings.push_back(*std::move(complaint));
  add_asked_sizes(surface, options.asked_sizes, options.tetgen_timeout, demand);
  const Tries tries = tries_of(surface, options, demand.greatest);
  const double least_factor = std::ranges::min(std::span(tried_sizes).first(tries.most));
  const bool places = places_points(options.points);
  // Before any memory is used for points, and before walls are measured.
  if (places) volume::check_point_count(surface, least_factor * demand.greatest, options.most_points);
  const sizing::SizeField size = sizing::field_of(surface, demand);
  if (places) volume::check_point_count(surface, least_factor * size, options.clearance, options.most_points);
  const double seconds_checking = watch.seconds();

  // How long the search for better points takes is up to the user.
  step.reset();
  step.emplace(nullptr, 0.02, options.improve > 0 ? 0.1 : 1);
  MeshedSurface meshed = best_of_tries(surface, demand, size, tries, meshing_options(options, tries.most > 1));
  step.reset();
  if (options.improve > 0)
    improve(meshed, surface, {options.improve, options.seed, options.time_limit, options.tetgen_timeout});
  TetmeshResult result = finish(std::move(meshed), surface, options);
  result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
  if (options.repair || (repaired && repaired->anything())) result.statistics.repair = repaired;
  if (options.unite) result.statistics.united_bodies = united;
  result.statistics.seconds.checking = seconds_checking;
  return result;
}

}  // namespace hexpipe::tetmesh
