#pragma once
// From a surface to tetrahedra: checks it, finds its shells, places points inside, calls TetGen, judges what it made.

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "formats/points/point_files.hpp"
#include "formats/surfaces/surface_files.hpp"
#include "tools/tetmesh/asked_sizes.hpp"
#include "tools/tetmesh/search/point_search.hpp"
#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/sizing/sizing.hpp"
#include "tools/tetmesh/solid/group_tags.hpp"
#include "tools/tetmesh/solid/repair.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/surface/surface_remesh.hpp"
#include "tools/tetmesh/volume/lattice.hpp"

namespace hexpipe::tetmesh {

// What becomes of the surface's triangles.
enum class SurfaceKind { remesh, keep };

enum class PointKind {
  best,     // of lattice and frame, the one whose mesh is estimated to merge into more hexes, or in each body
  mixed,    // of best, where bodies have different ones
  frame,    // along a frame field: frame_points.hpp
  lattice,  // along the part's axes: lattice.hpp
  given,    // by the user
  none
};

// By tetmesh; else there are none, or the user's.
constexpr bool places_points(PointKind kind) {
  return kind != PointKind::none && kind != PointKind::given;
}

constexpr std::size_t most_tries = 9;

struct TetmeshOptions {
  std::optional<sizing::Length> size = {};  // nothing: see greatest_size()
  sizing::SizeSources size_sources = {};
  std::vector<AskedSize> asked_sizes = {};        // at surfaces, in bodies and in boxes
  std::optional<double> curvature = {};           // elements a turn where the surface bends; nothing: it does not count
  std::optional<sizing::Length> least_size = {};  // by curvature; nothing: a fifth of the size
  double grading = 0.3;
  std::optional<int> layers = {};  // across thin walls, at least; nothing: walls do not count
  SurfaceKind surface = SurfaceKind::remesh;
  double feature_angle = default_feature_angle;
  double deviation = surface::RemeshOptions{}.deviation;      // in sizes, or in the thickness of thinner walls
  double row_stretch = surface::RemeshOptions{}.row_stretch;  // in sizes
  PointKind points = PointKind::best;
  formats::PointList given_points = {};  // for PointKind::given
  double clearance = volume::LatticeOptions{}.clearance;
  std::optional<double> jitter = {};  // nothing: that of the kind of points
  solid::ShellRule shells = solid::ShellRule::oriented;
  std::optional<double> tag_angle = {};  // nothing: the file's tags
  std::vector<solid::TagName> tag_names = {};
  std::uint64_t seed = 1;
  double most_points = 2e7;  // inside
  bool repair = false;
  sizing::Length weld = {1e-4, true};
  std::size_t largest_hole = solid::RepairOptions{}.largest_hole;
  double tetgen_timeout = 3600;  // seconds, of all runs that make one mesh
  std::size_t tries = 1;         // sizes, up to 5 % off, of which the one with most hexes is kept; at most most_tries
  std::size_t improve = 0;       // rounds of the search for better points
  std::optional<double> time_limit = {};                                  // of that search, seconds
  std::function<void(std::size_t round, double share)> after_round = {};  // of that search
};

struct StepSeconds {
  // One after the other. While TetGen is at work, other steps may be, too: then only the rest of its time counts.
  double checking = 0, remeshing = 0, placing = 0, tetgen = 0, building = 0, comparing = 0, improving = 0;
  double of_tetgen = 0;  // of the processor, all that TetGen took

  StepSeconds& operator+=(const StepSeconds& other);
};

struct TriedSize {
  double size;
  std::optional<double> hex_share;  // nothing where TetGen failed
};

struct TetmeshStatistics {
  double size = 0;                   // the greatest
  std::optional<double> least_size;  // where sizes differ
  std::size_t surface_points = 0, surface_triangles = 0;
  bool remeshed = false;
  int surfaces_tried = 0;                                 // by remeshing, until one was as promised
  double distance_to_input = 0, distance_from_input = 0;  // Hausdorff, of the new surface and of the old one
  std::size_t extra_points = 0;                           // of the input, that remeshing could not remove
  std::size_t shells = 0, regions = 0;
  std::size_t interior_points = 0;  // asked for
  std::optional<solid::RepairReport> repair;
  PointKind points_kept = PointKind::none;
  // Of the volume, by a rough greedy choice; where several kinds of points were tried.
  std::optional<double> lattice_hex_share, frame_hex_share, mixed_hex_share;
  std::size_t added_points = 0, dropped_points = 0;
  int tetgen_runs = 0;  // those that failed among them
  std::size_t points = 0, tets = 0;
  double volume = 0;
  double least_dihedral = 0, greatest_dihedral = 0;  // degrees
  std::optional<double> hex_share;  // of the mesh, estimated in the same way, where several sizes were tried
  std::vector<TriedSize> tried;     // these
  std::optional<search::PointSearchSummary> improved;
  StepSeconds seconds;  // of all tries
};

struct TetmeshResult {
  TetMesh mesh;
  formats::GroupNames names;
  TetmeshStatistics statistics;
  std::vector<std::string> warnings;
};

// Throws DataError for a surface that is not the boundary of a solid, and where TetGen fails; UsageError for options
// that contradict each other.
TetmeshResult tetmesh(formats::SurfaceSoup soup, const TetmeshOptions& options);

// Everything but the times, which differ from run to run; and these, in seconds by step.
nlohmann::ordered_json to_json(const TetmeshStatistics& statistics);
nlohmann::ordered_json times_of(const TetmeshStatistics& statistics);

}  // namespace hexpipe::tetmesh
