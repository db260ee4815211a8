#include "tools/tetmesh/fill.hpp"

#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "common/mesh/adjacency.hpp"
#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/parallel.hpp"
#include "tools/tetmesh/solid/model_axes.hpp"
#include "tools/tetmesh/surface/surface_remesh.hpp"
#include "tools/tetmesh/tetgen/run_tetgen.hpp"
#include "tools/tetmesh/volume/estimates.hpp"
#include "tools/tetmesh/volume/frame_points.hpp"
#include "tools/tetmesh/volume/given_points.hpp"
#include "tools/tetmesh/volume/lattice.hpp"

namespace hexpipe::tetmesh {
namespace {

using volume::places_points;
using volume::PointKind;

// Points that the user gives may come as near to the surface as TetGen can bear.
constexpr double clearance_of_given = 1e-3;  // in sizes

// In 31 meshes of eleven models the lattice won only where less than a seventh of the frames was turned, or where there
// were few tets. With few tets an estimate takes no time.
constexpr double much_turned = 0.2;
constexpr std::size_t few_tets = 8000;

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

// TetGen fails on some surfaces with slivers that are nearly coplanar: it crashes or loses triangles. With the same
// input in another order it succeeds. 9 of 36 meshes of a turned CAD tessellation failed at the first run; the worst
// needed 6 runs.
constexpr int most_runs = 16;
// Runs from this number on are strict, for shells that nearly touch: two cubes on top of each other, 1e-9 apart, failed
// at all other runs.
constexpr int first_strict_run = 8;

class Filler {
 public:
  Filler(const solid::Surface& given, const sizing::SizeDemand& demand, sizing::SizeField size,
         const FillOptions& options)
      : given_(given), demand_(demand), size_(std::move(size)), options_(options) {
    statistics_.size = size_.greatest();
    if (!size_.is_uniform()) statistics_.least_size = size_.least();
  }

  FilledSurface fill();

 private:
  // Returns false where no new surface can be made; the warning says why.
  bool fill_new_surface();
  void fill_given_surface();
  void place_points();
  void try_frame_points();
  // Is called while TetGen is at work, and returns false when its mesh is no longer wanted.
  using Meanwhile = std::function<bool()>;
  std::optional<tetgen::BuiltMesh> tetrahedralize(std::span<const Vec3> points, const Meanwhile& meanwhile);
  void describe(const surface::RemeshResult& remeshed);
  const solid::Surface& given_;
  const sizing::SizeDemand& demand_;
  const sizing::SizeField size_;
  const FillOptions& options_;
  TetmeshStatistics statistics_;
  std::optional<volume::LineSegments> dislocations_;
  std::vector<std::string> warnings_;
  StepWatch watch_;

  std::optional<surface::RemeshResult> remeshed_;
  std::optional<solid::Surface> cut_;        // a surface in sheets with its triangles cut to about the size
  const solid::Surface* surface_ = &given_;  // the surface that is filled
  solid::Axes axes_{};                       // of the model
  std::vector<Vec3> points_;                 // inside
  std::optional<std::string> points_left_out_;
  std::optional<tetgen::BuiltMesh> built_;
};

FilledSurface Filler::fill() {
  if (!options_.remesh || !fill_new_surface()) fill_given_surface();
  if (points_left_out_) warnings_.push_back(*points_left_out_);
  if (options_.points == PointKind::given && built_->dropped_points > 0)
    warnings_.push_back(fmt::format("{}: TetGen left out {} of {} points inside, too near to others",
                                    options_.given_points.name, built_->dropped_points, points_.size()));
  statistics_.points_kept = places_points(options_.points) ? PointKind::lattice : options_.points;
  statistics_.interior_points = points_.size();
  if (options_.points == PointKind::frame || options_.points == PointKind::best) {
    try {
      try_frame_points();
    } catch (const tetgen::TetGenFailure& failure) {
      if (options_.points == PointKind::frame) throw;
      warnings_.push_back(fmt::format("the points along the frame field are left out: {}", failure.what()));
    }
  }
  if (options_.estimates) {
    const auto& known =
        statistics_.points_kept == PointKind::frame ? statistics_.frame_hex_share : statistics_.lattice_hex_share;
    statistics_.hex_share = known ? *known : volume::estimate_hex_share(built_->mesh, built_->adjacency);
    watch_.add_to(statistics_.seconds.comparing);
  }
  std::optional<solid::Surface> made;
  if (remeshed_ && surface_ == &remeshed_->surface) made = std::move(remeshed_->surface);
  if (cut_) made = std::move(cut_);
  return {std::move(made),         size_, *std::move(built_), std::move(statistics_), std::move(warnings_),
          std::move(dislocations_)};
}

// TetGen works on the new surface while this thread judges that surface. TetGen may fail on the new surface and not on
// the given one, because their points differ.
bool Filler::fill_new_surface() {
  // A deviation in sizes is small beside the model, unless a wall is thinner than a size: then the wall's thickness
  // counts.
  const bool walls_count = !demand_.layers && !surface::asks_for_too_many_points(given_, size_);
  sizing::SizeDemand one_layer = demand_;
  one_layer.layers = 1;
  const sizing::SizeField unit = walls_count ? sizing::field_of(given_, std::move(one_layer)) : size_;
  surface::SurfaceRemesher remesher(given_,
                                    {size_, options_.feature_angle, options_.deviation, unit, options_.row_stretch});
  std::string failure;
  try {
    while (!built_) {
      options_.steps.begin(Step::remesh, given_.triangles.size());
      if (!remesher.make()) break;
      watch_.add_to(statistics_.seconds.remeshing);
      surface_ = &remesher.made();
      place_points();
      built_ = tetrahedralize(points_, [&] {
        const bool good = remesher.judge();
        watch_.add_to(statistics_.seconds.remeshing);
        return good;
      });
    }
  } catch (const tetgen::TetGenFailure& of_tetgen) {
    failure = of_tetgen.what();
  }
  watch_.add_to(statistics_.seconds.remeshing);
  remeshed_ = remesher.take();
  statistics_.surfaces_tried = remeshed_->attempts;
  if (built_) {
    surface_ = &remeshed_->surface;
    describe(*remeshed_);
  } else {
    warnings_.push_back(fmt::format("the surface is {}: {}",
                                    given_.has_sheets ? "only cut to the size" : "kept as it is",
                                    failure.empty() ? remeshed_->failure : failure));
  }
  return built_.has_value();
}

void Filler::fill_given_surface() {
  if (options_.remesh && given_.has_sheets) {
    cut_.emplace(surface::split_long_edges(given_, size_));
    watch_.add_to(statistics_.seconds.remeshing);
  }
  surface_ = cut_ ? &*cut_ : &given_;
  if (options_.points != PointKind::none && warnings_.empty()) {
    const auto complaint = sizing::fit_to_size(*surface_, size_).complaint(statistics_.size);
    if (complaint) warnings_.push_back(*complaint);
  }
  place_points();
  built_ = tetrahedralize(points_, [] { return true; });
}

void Filler::place_points() {
  options_.steps.begin(Step::place, surface_->triangles.size());
  if (places_points(options_.points)) {
    axes_ = solid::axes_of_model(*surface_, options_.feature_angle);
    points_ = volume::graded_lattice_points(*surface_, size_,
                                            {.clearance = options_.clearance,
                                             .jitter = options_.jitter.value_or(volume::LatticeOptions{}.jitter),
                                             .seed = options_.seed,
                                             .axes = axes_},
                                            options_.most_points);
  } else if (options_.points == PointKind::given) {
    volume::GivenPoints given =
        volume::usable_points(*surface_, options_.given_points, clearance_of_given * size_.least());
    points_ = std::move(given.points);
    points_left_out_ = std::move(given.complaint);
  }
  watch_.add_to(statistics_.seconds.placing);
}

// Starts from the mesh with the lattice's points, and keeps that mesh if it is the better one.
void Filler::try_frame_points() {
  options_.steps.begin(Step::follow_frames, built_->mesh.tets.size());
  const volume::FramePoints frame =
      volume::frame_points(*surface_, built_->mesh, built_->adjacency,
                           {.size = size_,
                            .clearance = options_.clearance,
                            .jitter = options_.jitter.value_or(volume::FramePointsOptions{}.jitter),
                            .seed = options_.seed,
                            .feature_angle = options_.feature_angle,
                            .axes = axes_});
  watch_.add_to(statistics_.seconds.placing);
  const bool compares = options_.points == PointKind::best &&
                        !frame_plainly_wins(statistics_.remeshed, frame.turned_share, built_->mesh.tets.size());
  double lattice_share = 0;
  std::optional<tetgen::BuiltMesh> bent = tetrahedralize(frame.points, [&] {
    if (compares) lattice_share = volume::estimate_hex_share(built_->mesh, built_->adjacency);
    watch_.add_to(statistics_.seconds.comparing);
    return true;
  });
  if (compares) {
    statistics_.lattice_hex_share = lattice_share;
    statistics_.frame_hex_share = volume::estimate_hex_share(bent->mesh, bent->adjacency);
    watch_.add_to(statistics_.seconds.comparing);
    if (lattice_share >= *statistics_.frame_hex_share) return;
  }
  built_ = std::move(bent);
  statistics_.interior_points = frame.points.size();
  const volume::Dislocations& lines = frame.dislocations;
  statistics_.dislocations = {lines.length, lines.at_singularities, lines.closed, lines.surface_ends};
  dislocations_ = lines.segments;
  statistics_.points_kept = PointKind::frame;
}

// Returns nothing where the mesh is not wanted.
std::optional<tetgen::BuiltMesh> Filler::tetrahedralize(std::span<const Vec3> points, const Meanwhile& meanwhile) {
  options_.steps.begin(built_ ? Step::fill_again : Step::fill, surface_->points.size() + points.size());
  // With one thread, TetGen and the other work follow each other.
  const bool at_once = thread_count() > 1;
  if (!at_once && !meanwhile()) return std::nullopt;
  const Deadline deadline(options_.tetgen_timeout);
  for (int run = 0;; ++run) {
    try {
      tetgen::TetGenRun tetgen({.surface_points = surface_->points,
                                .triangles = surface_->triangles,
                                .interior_points = points,
                                .shuffle = static_cast<std::uint64_t>(run),
                                .strict = run >= first_strict_run,
                                .names_intersecting = run + 1 == most_runs},
                               deadline.remaining());
      if (at_once && run == 0) {
        bool wanted = true;
        leaving_one_thread([&] { wanted = meanwhile(); });
        if (!wanted) return std::nullopt;
      }
      tetgen::TetGenResult made = tetgen.wait();
      ++statistics_.tetgen_runs;
      statistics_.seconds.of_tetgen += made.seconds;
      watch_.add_to(statistics_.seconds.tetgen);
      tetgen::BuiltMesh built = tetgen::build_mesh(*surface_, points, std::move(made));
      watch_.add_to(statistics_.seconds.building);
      return built;
    } catch (const tetgen::TetGenFailure&) {
      if (run + 1 == most_runs || deadline.passed()) throw;
    }
  }
}

void Filler::describe(const surface::RemeshResult& remeshed) {
  statistics_.remeshed = true;
  statistics_.distance_to_input = remeshed.to_input;
  statistics_.distance_from_input = remeshed.from_input;
  statistics_.extra_points = remeshed.extra_points;
  statistics_.row_ends = remeshed.row_ends;
}

}  // namespace

bool frame_plainly_wins(bool remeshed, double turned_share, std::size_t tets) {
  return remeshed && turned_share > much_turned && tets > few_tets;
}

FilledSurface fill(const solid::Surface& given, const sizing::SizeDemand& demand, sizing::SizeField size,
                   const FillOptions& options) {
  return Filler(given, demand, std::move(size), options).fill();
}

}  // namespace hexpipe::tetmesh
