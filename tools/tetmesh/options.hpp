#pragma once
// The command line of tetmesh.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "formats/points/point_files.hpp"
#include "tools/tetmesh/asked_sizes.hpp"
#include "tools/tetmesh/point_kind.hpp"
#include "tools/tetmesh/sizing/size_demand.hpp"
#include "tools/tetmesh/solid/group_tags.hpp"
#include "tools/tetmesh/solid/repair.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/surface/surface_remesh.hpp"
#include "tools/tetmesh/volume/lattice.hpp"

namespace hexpipe::tetmesh {

// Whether the surface's triangles are made anew or kept.
enum class SurfaceKind { remesh, keep };

constexpr std::size_t most_tries = 9;

struct TetmeshOptions {
  sizing::SizeRequest sizes = {};
  std::vector<AskedSize> asked_sizes = {};  // at surfaces, in bodies and in boxes
  SurfaceKind surface = SurfaceKind::remesh;
  double feature_angle = default_feature_angle;
  double deviation = surface::RemeshOptions{}.deviation;  // in sizes, or in the thickness of thinner walls
  double short_features = 0;                              // in sizes; those up to this go
  double row_stretch = surface::RowOptions{}.stretch;     // in sizes
  PointKind points = PointKind::best;
  formats::PointList given_points = {};  // for PointKind::given
  double clearance = volume::LatticeOptions{}.clearance;
  std::optional<double> jitter = {};  // nothing: the default of the kind of points
  solid::ShellRule shells = solid::ShellRule::oriented;
  std::optional<double> tag_angle = {};  // nothing: the file's tags
  std::vector<solid::TagName> tag_names = {};
  std::uint64_t seed = 1;
  double most_points = 2e7;  // inside
  bool mend = true;          // where nothing is changed by it; see solid::mend
  solid::BaffleRule baffles = solid::BaffleRule::drop;
  bool unite = false;  // bodies that overlap: solid::unite_bodies
  bool repair = false;
  sizing::Length weld = {1e-4, true};
  std::size_t largest_hole = solid::RepairOptions{}.largest_hole;
  double tetgen_timeout = 3600;  // seconds for all runs that make one mesh
  // Sizes up to 5 % off, of which the mesh with most hexes is kept; at most most_tries. Nothing: one where sizes are
  // asked for or the mesh is large, otherwise up to three.
  std::optional<std::size_t> tries = {};
  std::size_t improve = 0;                // rounds of the search for better points
  std::optional<double> time_limit = {};  // of that search, in seconds
};

// Prepares the words of a command line for CLI11, which takes any word behind an option as its optional value: a word
// behind --layers or --tags-by-angle that is no number is the surface. The words are those of argv, or last as long as
// the process.
std::vector<char*> words_for_parsing(int argc, char** argv);

// Throws UsageError where an option was given that does nothing beside the others, because the user expects it to act.
// `is_given` tells whether the option of a name was given; `points` is the value of --points.
void refuse_idle_options(const std::function<bool(const char*)>& is_given, const TetmeshOptions& options,
                         const std::string& points);

// Throws UsageError where the values of several options contradict each other, and DataError where the user gives more
// points than --most-points.
void check_options(const TetmeshOptions& options);

}  // namespace hexpipe::tetmesh
