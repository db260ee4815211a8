#include "tools/tetmesh/tetmesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numbers>
#include <string>
#include <utility>

#include "common/mesh/feature_angle.hpp"
#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "tools/tetmesh/asked_sizes.hpp"
#include "tools/tetmesh/fill.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/improve.hpp"
#include "tools/tetmesh/solid/sheets.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"
#include "tools/tetmesh/tetgen/build_mesh.hpp"
#include "tools/tetmesh/volume/expected_points.hpp"
#include "tools/tetmesh/volume/frame_points.hpp"

namespace hexpipe::tetmesh {

StepSeconds& StepSeconds::operator+=(const StepSeconds& other) {
  checking += other.checking;
  remeshing += other.remeshing;
  placing += other.placing;
  tetgen += other.tetgen;
  building += other.building;
  comparing += other.comparing;
  improving += other.improving;
  of_tetgen += other.of_tetgen;
  return *this;
}

namespace {

// Of the size, those that are tried, in this order. Whole numbers of cells across a part, and so the hexes, differ by
// points between them, in no order.
constexpr std::array<double, most_tries> tried_sizes{1, 0.95, 1.05, 0.975, 1.025, 0.9625, 1.0375, 0.9875, 1.0125};

void check_options(const TetmeshOptions& options) {
  if (options.tries > 1 && options.surface == SurfaceKind::keep && !places_points(options.points))
    throw UsageError("--tries has no sizes to try with --surface keep and without points to place");
  // Each coordinate moves by the jitter, a point by up to sqrt(3) times that; it must not reach the surface.
  if (!places_points(options.points)) return;
  const double jitter = options.jitter.value_or(volume::FramePointsOptions{}.jitter);
  if (jitter >= options.clearance / 2)
    throw UsageError(
        fmt::format("expected --jitter below half of --clearance, {:g}, found {:g}", options.clearance / 2, jitter));
}

// Before any memory is used for them, or walls are looked for.
void check_number_of_points(const solid::Surface& surface, const TetmeshOptions& options, double greatest_size) {
  const double most = options.most_points;
  const auto given = static_cast<double>(options.given_points.points.size());
  if (given > most)
    throw DataError::at(options.given_points.name, "expected at most {:g} points (see --most-points), found {:g}", most,
                        given);
  const double expected = sizing::points_expected(surface, greatest_size);
  if (places_points(options.points) && expected > most)
    throw DataError::at(surface.name,
                        "expected a size that makes at most {:g} points inside (see --most-points), found {:g}, which "
                        "makes about {:.3g}",
                        most, greatest_size, expected);
}

// Where sizes differ by place it is told early what makes far too many; else graded_lattice_points() counts.
void check_points_by_place(const solid::Surface& surface, const TetmeshOptions& options,
                           const sizing::SizeField& size) {
  const double far_too_many = 4 * options.most_points;
  if (places_points(options.points) && !size.is_uniform() &&
      volume::points_inside(surface, size, options.clearance, far_too_many) > far_too_many)
    throw DataError::at(surface.name,
                        "expected sizes that make at most {:g} points inside (see --most-points), found {:g} to {:g}, "
                        "which make more than {:g}",
                        options.most_points, size.least(), size.greatest(), far_too_many);
}

solid::RepairReport repair(formats::SurfaceSoup& soup, const TetmeshOptions& options) {
  const double unit = options.weld.percent_of_diagonal ? sizing::bounding_box_diagonal(soup) / 100 : 1;
  return solid::repair(soup, {options.weld.value * unit, options.largest_hole});
}

// Of the elements: what the user asks for, else the greatest of the sizes given by place, else what suits the part.
double greatest_size(const solid::Surface& surface, const TetmeshOptions& options) {
  if (options.size || options.size_sources.empty())
    return sizing::element_size(surface, options.size, options.surface == SurfaceKind::keep);
  return std::ranges::max(options.size_sources.sizes);
}

// Checked, with its shells, or its sheets where they meet at edges of more than two triangles.
solid::Surface surface_of(formats::SurfaceSoup soup, const TetmeshOptions& options,
                          std::vector<std::string>& warnings) {
  const char* remedy = options.repair ? "" : " (see --repair)";
  if (solid::meets_in_sheets(soup)) {
    solid::check_areas(soup, remedy);
    const bool has_sides = !soup.sides.empty();
    const solid::SheetReport found = has_sides ? solid::join_bodies(soup) : solid::find_sides(soup, options.shells);
    for (const std::string& sentence : found.sentences())
      warnings.push_back(fmt::format("{}: {}", soup.name, sentence));
  }
  if (!solid::meets_in_sheets(soup)) {
    solid::check_surface(soup, remedy);
    return solid::find_shells(std::move(soup), options.shells);
  }
  return solid::find_sheets(std::move(soup));
}

// Where neighbours on the surface turn by an angle, over the distance of their outer corners from the common edge, the
// radius is the one over the other.
void add_curvature_sizes(const solid::Surface& surface, TetmeshOptions& options, double greatest) {
  constexpr double least_of_size = 0.2, least_angle = 1e-3;
  constexpr Vertex none = sizing::SizeSources::none;
  const double least =
      options.least_size ? sizing::element_size(surface, options.least_size) : least_of_size * greatest;
  const double feature_cosine = cosine_of_degrees(options.feature_angle);
  sizing::SizeSources& sources = options.size_sources;
  geometry::for_each_edge(surface.points.size(), surface.triangles, [&](std::span<const geometry::HalfEdge> edge) {
    if (edge.size() != 2) return;
    const Vec3& a = surface.points[geometry::start_of(surface.triangles, edge[0])];
    const Vec3& b = surface.points[geometry::end_of(surface.triangles, edge[0])];
    std::array<Vec3, 2> areas;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto [p, q, r] = surface.triangles[geometry::triangle_of(edge[i])];
      areas[i] = cross(surface.points[q] - surface.points[p], surface.points[r] - surface.points[p]);
    }
    const double cosine = dot(unit(areas[0]), unit(areas[1]));
    if (cosine < feature_cosine) return;
    const double angle = std::atan2(norm(cross(unit(areas[0]), unit(areas[1]))), cosine);
    const double width = (norm(areas[0]) + norm(areas[1])) / 2 / norm(b - a);
    const double size = std::max(least, 2 * std::numbers::pi / *options.curvature * width / angle);
    if (angle < least_angle || size >= greatest) return;
    const auto first = static_cast<Vertex>(sources.points.size());
    sources.points.insert(sources.points.end(), {a, b});
    sources.sizes.insert(sources.sizes.end(), 2, size);
    sources.simplices.push_back({first, first + 1, none, none});
  });
}

FilledSurface fill_at(double factor, const solid::Surface& surface, TetmeshOptions options,
                      const sizing::SizeField& size) {
  const bool estimates = options.tries > 1;
  if (factor == 1) return fill(surface, options, size, estimates);
  for (double& known : options.size_sources.sizes) known *= factor;
  return fill(surface, options, size_field(surface, options, factor * size.greatest(), options.layers), estimates);
}

// The one that is estimated to have most hexes. A size at which TetGen fails is passed over, unless it does at all.
FilledSurface best_of_tries(const solid::Surface& surface, const TetmeshOptions& options,
                            const sizing::SizeField& size) {
  std::optional<FilledSurface> best;
  std::vector<TriedSize> tried;
  StepSeconds seconds;
  std::exception_ptr failure;
  for (const double factor : std::span(tried_sizes).first(options.tries)) {
    try {
      FilledSurface filled = fill_at(factor, surface, options, size);
      const TetmeshStatistics& statistics = filled.result.statistics;
      tried.push_back({statistics.size, statistics.hex_share});
      seconds += statistics.seconds;
      if (!best || statistics.hex_share > best->result.statistics.hex_share) best = std::move(filled);
    } catch (const tetgen::TetGenFailure&) {
      tried.push_back({factor * size.greatest(), {}});
      if (!failure) failure = std::current_exception();
    }
  }
  if (!best) std::rethrow_exception(failure);
  best->result.statistics.seconds = seconds;
  if (options.tries > 1) best->result.statistics.tried = std::move(tried);
  return *std::move(best);
}

const char* name_of(PointKind kind) {
  switch (kind) {
    case PointKind::best:
      return "best";
    case PointKind::mixed:
      return "mixed";
    case PointKind::frame:
      return "frame";
    case PointKind::lattice:
      return "lattice";
    case PointKind::given:
      return "given";
    case PointKind::none:
      break;
  }
  return "none";
}

}  // namespace

TetmeshResult tetmesh(formats::SurfaceSoup soup, const TetmeshOptions& given_options) {
  check_options(given_options);
  const Stopwatch watch;
  std::optional<solid::RepairReport> repaired;
  if (given_options.repair) repaired = repair(soup, given_options);
  std::vector<std::string> warnings;
  solid::Surface given = surface_of(std::move(soup), given_options, warnings);
  if (given_options.tag_angle) solid::tag_by_angle(given, *given_options.tag_angle);
  solid::name_tags(given, given_options.tag_names);
  const solid::Surface surface = std::move(given);
  double greatest = greatest_size(surface, given_options);
  TetmeshOptions options = given_options;
  if (options.curvature) add_curvature_sizes(surface, options, greatest);
  AskedSizes asked = asked_sizes(surface, options, greatest);
  options.size_sources = std::move(asked.sources);
  greatest = asked.greatest;
  const double least_factor = std::ranges::min(std::span(tried_sizes).first(options.tries));
  check_number_of_points(surface, options, least_factor * greatest);
  const sizing::SizeField size = size_field(surface, options, greatest, options.layers);
  check_points_by_place(surface, options, least_factor * size);
  const double seconds_checking = watch.seconds();

  FilledSurface filled = best_of_tries(surface, options, size);
  if (options.improve > 0) improve(filled, surface, options);
  TetmeshResult result = finish(std::move(filled), surface);
  result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
  result.names = surface.names;
  result.statistics.repair = repaired;
  result.statistics.seconds.checking = seconds_checking;
  return result;
}

nlohmann::ordered_json to_json(const TetmeshStatistics& s) {
  nlohmann::ordered_json json{{"size", s.size},
                              {"surface_points", s.surface_points},
                              {"surface_triangles", s.surface_triangles},
                              {"surface_remeshed", s.remeshed},
                              {"surfaces_tried", s.surfaces_tried},
                              {"distance_to_input", s.distance_to_input},
                              {"distance_from_input", s.distance_from_input},
                              {"extra_points", s.extra_points},
                              {"shells", s.shells},
                              {"regions", s.regions},
                              {"points_kept", name_of(s.points_kept)},
                              {"interior_points", s.interior_points},
                              {"added_points", s.added_points},
                              {"dropped_points", s.dropped_points},
                              {"tetgen_runs", s.tetgen_runs},
                              {"points", s.points},
                              {"tets", s.tets},
                              {"volume", s.volume},
                              {"least_dihedral", s.least_dihedral},
                              {"greatest_dihedral", s.greatest_dihedral}};
  if (s.least_size) json["least_size"] = *s.least_size;
  if (s.repair) json["repair"] = solid::to_json(*s.repair);
  if (s.lattice_hex_share)
    json["estimated_hex_share"] = {{"lattice", *s.lattice_hex_share}, {"frame", *s.frame_hex_share}};
  if (s.mixed_hex_share) json["estimated_hex_share"]["mixed"] = *s.mixed_hex_share;
  if (s.improved)
    json["improved"] = {{"rounds", s.improved->rounds},
                        {"changes", s.improved->changes},
                        {"estimated_hex_share_before", s.improved->share_before},
                        {"estimated_hex_share", s.improved->share}};
  for (const auto& [size, share] : s.tried)
    json["tried"].push_back(
        {{"size", size}, {"estimated_hex_share", share ? nlohmann::ordered_json(*share) : nullptr}});
  return json;
}

nlohmann::ordered_json times_of(const TetmeshStatistics& statistics) {
  const StepSeconds& s = statistics.seconds;
  return {{"checking", s.checking}, {"remeshing", s.remeshing}, {"placing", s.placing},    {"tetgen", s.tetgen},
          {"building", s.building}, {"comparing", s.comparing}, {"improving", s.improving}};
}

}  // namespace hexpipe::tetmesh
