#include "tools/tetmesh/fill.hpp"

#include <algorithm>

#include "common/mesh/adjacency.hpp"
#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/parallel.hpp"
#include "tools/tetmesh/build_mesh.hpp"
#include "tools/tetmesh/graded_lattice.hpp"
#include "tools/tetmesh/mesh_shape.hpp"
#include "tools/tetmesh/part_axes.hpp"
#include "tools/tetmesh/run_tetgen.hpp"
#include "tools/tetmesh/volume/frame_points.hpp"
#include "tools/tetmesh/volume/given_points.hpp"
#include "tools/tetmesh/volume/hex_estimate.hpp"
#include "tools/tetmesh/wall_thickness.hpp"

namespace hexpipe {
namespace {

// Walls count with so many layers.
SizeField size_field(const Surface& surface, const TetmeshOptions& options, double greatest,
                     std::optional<int> layers) {
  SizeSources sources = options.size_sources;
  if (layers) sources.prisms = wall_sizes(surface, greatest, *layers);
  return {std::move(sources), greatest, options.grading};
}

// A point given by the user may come as near to the surface as TetGen can bear.
constexpr double clearance_of_given = 1e-3;  // in sizes

bool starts_from_lattice(PointKind kind) {
  return kind != PointKind::none && kind != PointKind::given;
}

// `axes` are the part's.
std::vector<Vec3> place_points(const Surface& surface, const SizeField& size, const Axes& axes,
                               const TetmeshOptions& options, TetmeshResult& result) {
  if (options.points == PointKind::none) return {};
  if (options.points == PointKind::given) {
    GivenPoints given = usable_points(surface, options.given_points, clearance_of_given * size.least());
    if (given.complaint) result.warning = given.complaint;
    return given.points;
  }
  return graded_lattice_points(surface, size,
                               {.clearance = options.clearance,
                                .jitter = options.jitter.value_or(LatticeOptions{}.jitter),
                                .seed = options.seed,
                                .axes = axes},
                               options.most_points);
}

void describe(const Surface& surface, TetmeshStatistics& statistics) {
  statistics.surface_points = surface.points.size();
  statistics.surface_triangles = surface.triangles.size();
  statistics.shells = surface.shells.size();
  statistics.regions = static_cast<std::size_t>(surface.region_count);
}

// Where no new surface can be made there is none, and the result says so.
std::optional<Surface> remesh(const Surface& surface, const SizeField& size, const TetmeshOptions& options,
                              TetmeshResult& result) {
  TetmeshStatistics& statistics = result.statistics;
  // What a size may take is nothing beside the part, unless that is thinner than a size.
  const SizeField unit = options.layers ? size : size_field(surface, options, size.greatest(), 1);
  RemeshResult remeshed = remesh_surface(surface, {size, options.feature_angle, options.deviation, unit});
  statistics.remeshed = remeshed.failure.empty();
  if (!statistics.remeshed) {
    result.warning = fmt::format("the surface is kept as it is: {}", remeshed.failure);
    return std::nullopt;
  }
  statistics.distance_to_input = remeshed.to_input;
  statistics.distance_from_input = remeshed.from_input;
  statistics.extra_points = remeshed.extra_points;
  return find_shells(std::move(remeshed.soup), options.shells);
}

void describe(const BuiltMesh& built, TetmeshStatistics& statistics) {
  const MeshShape shape = shape_of(built.mesh);
  statistics.points = built.mesh.points.size();
  statistics.tets = built.mesh.tets.size();
  statistics.added_points = built.added_points;
  statistics.dropped_points = built.dropped_points;
  statistics.volume = shape.volume;
  statistics.least_dihedral = shape.least_dihedral;
  statistics.greatest_dihedral = shape.greatest_dihedral;
}

// Adds the seconds since the last call, or since the start, to a step.
class StepWatch {
 public:
  void add_to(double& step) {
    step += watch_.seconds();
    watch_ = Stopwatch();
  }

 private:
  Stopwatch watch_;
};

// TetGen fails on some surfaces of nearly coplanar slivers, by a crash or by losing triangles, in one order of its
// input and not in another. Of 36 meshes of a CAD tessellation turned out of the axes 9 failed at the first run; the
// worst needed 6.
constexpr int most_runs = 16;
BuiltMesh tetrahedralize(const Surface& surface, std::span<const Vec3> points, double timeout, StepWatch& watch,
                         TetmeshStatistics& statistics) {
  const Deadline deadline(timeout);
  for (int run = 0;; ++run) {
    try {
      TetGenResult tetgen = run_tetgen({.surface_points = surface.points,
                                        .triangles = surface.triangles,
                                        .interior_points = points,
                                        .shuffle = static_cast<std::uint64_t>(run)},
                                       deadline.remaining());
      ++statistics.tetgen_runs;
      watch.add_to(statistics.seconds.tetgen);
      BuiltMesh built = build_mesh(surface, points, std::move(tetgen));
      watch.add_to(statistics.seconds.building);
      return built;
    } catch (const TetGenFailure&) {
      if (run + 1 == most_runs || deadline.passed()) throw;
    }
  }
}

// Whether it is plain that the frame's points give more hexes than the lattice's: where much of the part is turned out
// of the lattice's axes. Of 31 meshes of eleven parts the lattice won only with less than a seventh of it, or with few
// tets, where an estimate takes no time.
constexpr double much_turned = 0.2;
constexpr std::size_t few_tets = 8000;
bool frame_plainly_wins(const FramePoints& frame, const TetMesh& of_lattice, const TetmeshStatistics& statistics) {
  return statistics.remeshed && frame.turned_share > much_turned && of_lattice.tets.size() > few_tets;
}

// From the mesh with the lattice's points, which stays where it is the better one.
void try_frame_points(const Surface& surface, const SizeField& size, const Axes& axes, const TetmeshOptions& options,
                      StepWatch& watch, BuiltMesh& built, TetmeshStatistics& statistics) {
  const FramePoints frame = frame_points(surface, built.mesh, built.adjacency,
                                         {.size = size,
                                          .clearance = options.clearance,
                                          .jitter = options.jitter.value_or(FramePointsOptions{}.jitter),
                                          .seed = options.seed,
                                          .axes = axes});
  watch.add_to(statistics.seconds.placing);
  BuiltMesh bent = tetrahedralize(surface, frame.points, options.tetgen_timeout, watch, statistics);
  if (options.points == PointKind::best && !frame_plainly_wins(frame, built.mesh, statistics)) {
    both_at_once([&] { statistics.lattice_hex_share = estimate_hex_share(built.mesh, built.adjacency); },
                 [&] { statistics.frame_hex_share = estimate_hex_share(bent.mesh, bent.adjacency); });
    watch.add_to(statistics.seconds.comparing);
    if (*statistics.lattice_hex_share >= *statistics.frame_hex_share) return;
  }
  built = std::move(bent);
  statistics.interior_points = frame.points.size();
  statistics.points_kept = PointKind::frame;
}

}  // namespace

TetmeshResult fill(const Surface& given, const TetmeshOptions& options, double greatest_size, bool estimates) {
  TetmeshResult result;
  TetmeshStatistics& statistics = result.statistics;
  StepWatch watch;
  statistics.size = greatest_size;
  const SizeField size = size_field(given, options, greatest_size, options.layers);
  if (!size.is_uniform()) statistics.least_size = size.least();
  std::optional<Surface> remeshed;
  if (options.surface == SurfaceKind::remesh) {
    remeshed = remesh(given, size, options, result);
    watch.add_to(statistics.seconds.remeshing);
  }
  const Surface& surface = remeshed ? *remeshed : given;
  describe(surface, statistics);
  if (options.points != PointKind::none && !statistics.remeshed && !result.warning)
    result.warning = fit_to_size(surface, size).complaint(statistics.size);
  const Axes axes = starts_from_lattice(options.points) ? axes_of_part(surface) : Axes{};
  const std::vector<Vec3> points = place_points(surface, size, axes, options, result);
  statistics.interior_points = points.size();
  watch.add_to(statistics.seconds.placing);

  BuiltMesh built = tetrahedralize(surface, points, options.tetgen_timeout, watch, statistics);
  statistics.points_kept = starts_from_lattice(options.points) ? PointKind::lattice : options.points;
  if (options.points == PointKind::frame || options.points == PointKind::best) {
    try {
      try_frame_points(surface, size, axes, options, watch, built, statistics);
    } catch (const TetGenFailure&) {
      if (options.points == PointKind::frame) throw;
    }
  }
  if (estimates) {
    const auto& known =
        statistics.points_kept == PointKind::frame ? statistics.frame_hex_share : statistics.lattice_hex_share;
    statistics.hex_share = known ? *known : estimate_hex_share(built.mesh, built.adjacency);
    watch.add_to(statistics.seconds.comparing);
  }
  describe(built, statistics);
  result.mesh = std::move(built.mesh);
  watch.add_to(statistics.seconds.building);
  return result;
}

}  // namespace hexpipe
