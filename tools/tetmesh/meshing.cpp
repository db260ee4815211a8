#include "tools/tetmesh/meshing.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/parallel.hpp"
#include "common/run/progress.hpp"
#include "tools/tetmesh/sizing/sizing.hpp"
#include "tools/tetmesh/solid/model_axes.hpp"
#include "tools/tetmesh/surface/short_features.hpp"
#include "tools/tetmesh/surface/surface_remesh.hpp"
#include "tools/tetmesh/tetgen/run_tetgen.hpp"
#include "tools/tetmesh/volume/estimates.hpp"
#include "tools/tetmesh/volume/frame_points.hpp"
#include "tools/tetmesh/volume/given_points.hpp"
#include "tools/tetmesh/volume/lattice.hpp"

namespace hexpipe::tetmesh {
namespace {

// Points that the user gives may come as near to the surface as TetGen can bear.
constexpr double clearance_of_given = 1e-3;  // in sizes

// Where this share of the frames is turned, the lattice never won on a surface made anew. With few tets an estimate
// takes no time.
constexpr double much_turned = 0.2;
constexpr std::size_t few_tets = 8000;

// The lattice's points are moved less, which alone is worth 0.7 points of the estimate on a box that both fill with
// hexes; and hexes along the frame field have fewer other cells between them, which the estimate does not see.
constexpr double clear_lead = 0.01;

// The surface follows the lattice inside where the mean wall is at least this many sizes thick; with the size that
// tetmesh chooses, it has two. In thinner walls the surface knows more: on plate-holes, of one and a half sizes, 77.6 %
// of the cells are hexes if it follows, 85.9 if not. Its rows end where they fall there: whole numbers of them between
// features bend rows on one side of a wall off those on the other.
constexpr double least_wall_to_follow = 1.9;

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
// Shares of the time that a mesh takes, as on models of 17,000 to 170,000 tets, for the line of progress.
constexpr double surface_ends = 0.28, first_mesh_ends = 0.45, frame_ends = 0.85;
// The same within the step between the last two of these.
constexpr double frames_end = 0.16, fit_ends = 0.83;
// For each point, a run of TetGen takes about this long; for the line of progress, too.
constexpr double tetgen_seconds_a_point = 2e-5;
// Runs from this number on are strict, for shells that nearly touch: two cubes on top of each other, 1e-9 apart, failed
// at all other runs.
constexpr int first_strict_run = 8;

class Mesher {
 public:
  Mesher(const solid::Surface& given, const sizing::SizeDemand& demand, sizing::SizeField size,
         const MeshingOptions& options)
      : given_(given), demand_(demand), size_(std::move(size)), options_(options) {
    statistics_.size = size_.greatest();
    if (!size_.is_uniform()) statistics_.least_size = size_.least();
  }

  MeshedSurface mesh();

 private:
  // Returns false where no new surface can be made; the warning says why.
  bool mesh_new_surface();
  // Returns why it failed, or nothing. What is remeshed has to outlive the remesher.
  std::string remesh(const solid::Surface& shape);
  void mesh_given_surface();
  void place_points();
  void try_frame_points();
  bool follow(volume::FrameLattice& lattice);
  bool has_thick_walls() const {
    return sizing::mean_wall_thickness(given_) >= least_wall_to_follow * size_.greatest();
  }
  void describe(const volume::FramePoints& frame);
  void describe(const volume::Dislocations& lines);
  // A mesh, the hexes that are likely in it, and the surface that it fills.
  struct EstimatedMesh {
    const tetgen::BuiltMesh& built;
    const volume::HexEstimate& estimate;
    const solid::Surface& surface;
  };
  void try_points_by_body(const EstimatedMesh& lattice, const EstimatedMesh& frame);
  void take(const solid::Surface& surface);
  std::optional<double> known_hex_share() const;
  // Is called while TetGen is at work, and returns false when its mesh is no longer wanted.
  using Meanwhile = std::function<bool()>;
  std::optional<tetgen::BuiltMesh> tetrahedralize(const solid::Surface& surface, std::span<const Vec3> points,
                                                  const Meanwhile& meanwhile);
  void describe(const surface::RemeshResult& remeshed);
  const solid::Surface& given_;
  const sizing::SizeDemand& demand_;
  const sizing::SizeField size_;
  const MeshingOptions& options_;
  TetmeshStatistics statistics_;
  std::optional<volume::LineSegments> dislocations_;
  std::vector<std::string> warnings_;
  StepWatch watch_;

  std::optional<surface::JoinedFeatures> joined_;  // what is remeshed in place of the given surface
  std::optional<surface::SurfaceRemesher> remesher_;
  std::optional<surface::RemeshResult> remeshed_;
  std::optional<surface::RemeshResult> followed_;  // the one whose points are those of the lattice inside
  std::optional<solid::Surface> cut_;              // a surface in sheets with its triangles cut to about the size
  const solid::Surface* surface_ = &given_;        // the surface that is meshed
  solid::Axes axes_{};                             // of the model
  std::vector<Vec3> points_;                       // inside
  std::optional<std::string> points_left_out_;
  std::optional<tetgen::BuiltMesh> built_;
};

MeshedSurface Mesher::mesh() {
  if (!options_.remesh || !mesh_new_surface()) mesh_given_surface();
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
    const std::optional<double> known = known_hex_share();
    statistics_.hex_share = known ? *known : volume::estimate_hex_share(built_->mesh, built_->adjacency);
    watch_.add_to(statistics_.seconds.comparing);
  }
  std::optional<solid::Surface> made;
  if (remeshed_ && surface_ == &remeshed_->surface) made = std::move(remeshed_->surface);
  if (followed_ && surface_ == &followed_->surface) made = std::move(followed_->surface);
  if (cut_) made = std::move(cut_);
  return {std::move(made),         size_, *std::move(built_), std::move(statistics_), std::move(warnings_),
          std::move(dislocations_)};
}

bool Mesher::mesh_new_surface() {
  if (options_.short_features > 0 && !surface::asks_for_too_many_points(given_, size_))
    joined_ = surface::join_short_features(given_, options_.feature_angle, options_.short_features * size_);
  if (joined_) {
    if (remesh(joined_->surface).empty()) return true;
    warnings_.push_back("short features stay: without them no new surface is good enough");
    joined_.reset();
  }
  const std::string failure = remesh(given_);
  if (!failure.empty())
    warnings_.push_back(
        fmt::format("the surface is {}: {}", given_.has_sheets ? "only cut to the size" : "kept as it is", failure));
  return failure.empty();
}

// TetGen works on the new surface while this thread judges that surface. TetGen may fail on the new surface and not on
// the given one, because their points differ.
std::string Mesher::remesh(const solid::Surface& shape) {
  surface::RemeshOptions options{size_,
                                 options_.feature_angle,
                                 options_.deviation,
                                 {},
                                 {.stretch = options_.row_stretch, .are_whole = has_thick_walls()}};
  // A deviation in sizes is small beside the model, unless a wall is thinner than a size: then the wall's thickness
  // counts.
  if (!demand_.layers && !surface::asks_for_too_many_points(given_, size_)) {
    sizing::SizeDemand one_layer = demand_;
    one_layer.layers = 1;
    options.unit = sizing::field_of(shape, std::move(one_layer));
  }
  surface::SurfaceRemesher& remesher = remesher_.emplace(given_, shape, options);
  const auto make = [&] {
    const Step step("making new triangles for the surface", 0, surface_ends);
    return remesher.make();
  };
  std::string failure;
  try {
    while (!built_ && make()) {
      const Step step("filling the surface with tets", surface_ends, first_mesh_ends);
      watch_.add_to(statistics_.seconds.remeshing);
      surface_ = &remesher.made();
      place_points();
      built_ = tetrahedralize(*surface_, points_, [&] {
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
  if (!built_) return failure.empty() ? remeshed_->failure : failure;
  surface_ = &remeshed_->surface;
  describe(*remeshed_);
  return {};
}

void Mesher::mesh_given_surface() {
  if (options_.remesh && given_.has_sheets) {
    cut_.emplace(surface::split_long_edges(given_, size_));
    watch_.add_to(statistics_.seconds.remeshing);
  }
  const Step step("filling the surface with tets", surface_ends, first_mesh_ends);
  surface_ = cut_ ? &*cut_ : &given_;
  if (options_.points != PointKind::none && warnings_.empty()) {
    const auto complaint = sizing::fit_to_size(*surface_, size_).complaint(statistics_.size);
    if (complaint) warnings_.push_back(*complaint);
  }
  place_points();
  built_ = tetrahedralize(*surface_, points_, [] { return true; });
}

void Mesher::place_points() {
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
void Mesher::try_frame_points() {
  std::optional<Step> step(std::in_place, "placing points in rows", first_mesh_ends, frame_ends);
  const bool has_bodies = surface_->region_count > 1;
  const solid::Surface* const first = surface_;
  volume::FrameLattice lattice(*first, built_->mesh, built_->adjacency,
                               {.size = size_,
                                .clearance = options_.clearance,
                                .jitter = options_.jitter.value_or(volume::FramePointsOptions{}.jitter),
                                .seed = options_.seed,
                                .feature_angle = options_.feature_angle,
                                .axes = axes_});
  const solid::Surface* const of_frame_points = follow(lattice) ? &followed_->surface : first;
  std::optional<Step> placing(std::in_place, nullptr, fit_ends, 1);
  const volume::FramePoints frame = lattice.points_inside(*of_frame_points);
  placing.reset();
  watch_.add_to(statistics_.seconds.placing);
  const bool compares =
      options_.points == PointKind::best &&
      (has_bodies || !frame_plainly_wins(statistics_.remeshed, frame.turned_share, built_->mesh.tets.size()));
  step.reset();
  step.emplace("filling the surface with tets again", frame_ends, 1);
  volume::HexEstimate of_lattice;
  std::optional<tetgen::BuiltMesh> bent = tetrahedralize(*of_frame_points, frame.points, [&] {
    if (compares) of_lattice = volume::estimate_hexes(built_->mesh, built_->adjacency);
    watch_.add_to(statistics_.seconds.comparing);
    return true;
  });
  volume::HexEstimate of_frame;
  if (compares) {
    of_frame = volume::estimate_hexes(bent->mesh, bent->adjacency);
    statistics_.lattice_hex_share = of_lattice.share();
    statistics_.frame_hex_share = of_frame.share();
    watch_.add_to(statistics_.seconds.comparing);
  }
  const bool takes_frame = !compares || frame_wins(of_lattice.share(), of_frame.share());
  if (takes_frame) {
    std::swap(built_, bent);
    describe(frame);
    describe(lattice.dislocations());
    take(*of_frame_points);
  }
  if (!has_bodies || !compares) return;
  const auto& [with_lattice, with_frame] = takes_frame ? std::tie(*bent, *built_) : std::tie(*built_, *bent);
  try_points_by_body({with_lattice, of_lattice, *first}, {with_frame, of_frame, *of_frame_points});
}

// Fits the lattice, and makes the surface again with points where the lattice has them. The surface's own lattice does
// not know what lies inside, so its rows end in other places on one side of a wall than on the other, and the lines
// between these ends are bent. Returns false where the surface stays; then its points hold the lattice.
bool Mesher::follow(volume::FrameLattice& lattice) {
  const Step step(nullptr, frames_end, fit_ends);
  bool follows = false;
  if (statistics_.remeshed && has_thick_walls()) {
    lattice.fit(remeshed_->on_feature);
    watch_.add_to(statistics_.seconds.placing);
    remesher_->follow(lattice.guide());
    while (!follows && remesher_->make()) follows = remesher_->judge();
    followed_ = remesher_->take();
    watch_.add_to(statistics_.seconds.remeshing);
  }
  if (!follows) lattice.fit({});
  return follows;
}

// Gives each body the kind of points that is better in it, where that is not the same kind in all of them.
void Mesher::try_points_by_body(const EstimatedMesh& lattice, const EstimatedMesh& frame) {
  std::vector<bool> takes_frame(lattice.estimate.volumes.size());
  for (std::size_t region = 0; region < takes_frame.size(); ++region)
    takes_frame[region] = frame_wins(lattice.estimate.share_of(region), frame.estimate.share_of(region));
  std::vector<Vec3> points;
  std::size_t of_kind[2] = {};
  for (const bool is_frame : {false, true}) {
    const EstimatedMesh& mesh = is_frame ? frame : lattice;
    const tetgen::BuiltMesh& built = mesh.built;
    const std::size_t last = built.mesh.points.size() - built.added_points;
    for (std::size_t v = mesh.surface.points.size(); v < last; ++v) {
      const std::int32_t region = built.mesh.tet_tags[built.adjacency.tets_at(static_cast<Vertex>(v)).front()];
      if (takes_frame[region] != is_frame) continue;
      points.push_back(built.mesh.points[v]);
      ++of_kind[is_frame];
    }
  }
  if (of_kind[0] == 0 || of_kind[1] == 0) return;
  try {
    std::optional<tetgen::BuiltMesh> mixed = tetrahedralize(frame.surface, points, [] { return true; });
    statistics_.mixed_hex_share = volume::estimate_hex_share(mixed->mesh, mixed->adjacency);
    watch_.add_to(statistics_.seconds.comparing);
    if (*statistics_.mixed_hex_share <= *known_hex_share()) return;
    built_ = std::move(mixed);
    statistics_.interior_points = points.size();
    statistics_.points_kept = PointKind::mixed;
    statistics_.dislocations.reset();
    dislocations_.reset();
    take(frame.surface);
  } catch (const tetgen::TetGenFailure&) {
    // One of the others stands.
  }
}

// Makes this one the surface that is meshed.
void Mesher::take(const solid::Surface& surface) {
  surface_ = &surface;
  if (followed_ && surface_ == &followed_->surface) describe(*followed_);
}

// Returns nothing where the mesh is not wanted.
std::optional<tetgen::BuiltMesh> Mesher::tetrahedralize(const solid::Surface& surface, std::span<const Vec3> points,
                                                        const Meanwhile& meanwhile) {
  // With one thread, TetGen and the other work follow each other.
  const bool at_once = thread_count() > 1;
  if (!at_once && !meanwhile()) return std::nullopt;
  const Deadline deadline(options_.tetgen_timeout);
  Step step(nullptr);
  step.usually_takes(tetgen_seconds_a_point * static_cast<double>(surface.points.size() + points.size()));
  for (int run = 0;; ++run) {
    try {
      tetgen::TetGenRun tetgen({.surface_points = surface.points,
                                .triangles = surface.triangles,
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
      tetgen::BuiltMesh built = tetgen::build_mesh(surface, points, std::move(made));
      watch_.add_to(statistics_.seconds.building);
      return built;
    } catch (const tetgen::TetGenFailure&) {
      if (run + 1 == most_runs || deadline.passed()) throw;
    }
  }
}

void Mesher::describe(const surface::RemeshResult& remeshed) {
  statistics_.remeshed = true;
  statistics_.short_features = joined_ ? joined_->count : 0;
  statistics_.distance_to_input = remeshed.to_input;
  statistics_.distance_from_input = remeshed.from_input;
  statistics_.extra_points = remeshed.extra_points;
  statistics_.row_ends = remeshed.row_ends;
}

void Mesher::describe(const volume::FramePoints& frame) {
  statistics_.interior_points = frame.points.size();
  statistics_.points_kept = PointKind::frame;
}

void Mesher::describe(const volume::Dislocations& lines) {
  statistics_.dislocations = {lines.length, lines.at_singularities, lines.closed, lines.surface_ends};
  if (!lines.segments.empty()) dislocations_ = lines.segments;
}

// The share of hexes in the mesh that is kept, where it was estimated.
std::optional<double> Mesher::known_hex_share() const {
  if (statistics_.points_kept == PointKind::mixed) return statistics_.mixed_hex_share;
  return statistics_.points_kept == PointKind::frame ? statistics_.frame_hex_share : statistics_.lattice_hex_share;
}

}  // namespace

bool frame_plainly_wins(bool remeshed, double turned_share, std::size_t tets) {
  return remeshed && turned_share > much_turned && tets > few_tets;
}

bool frame_wins(double lattice_share, double frame_share) {
  return frame_share + clear_lead >= lattice_share;
}

MeshedSurface mesh_surface(const solid::Surface& given, const sizing::SizeDemand& demand, sizing::SizeField size,
                           const MeshingOptions& options) {
  return Mesher(given, demand, std::move(size), options).mesh();
}

}  // namespace hexpipe::tetmesh
