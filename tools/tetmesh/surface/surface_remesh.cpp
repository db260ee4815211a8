// The steps: sample features, and the middles of small fillets, as densely as rows of points should begin there; make
// the triangles that carry the field; put points on them by a front; insert these points; remove all other vertices.
// On organic surfaces vertices step out of it last, where faces came far. The result is judged as a whole. In the next
// attempt, what came too far, on either surface, is measured closely, and around other faults the input's own vertices
// stay; in the last two, its triangles do.

#include "tools/tetmesh/surface/surface_remesh.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/run/parallel.hpp"
#include "common/run/progress.hpp"
#include "tools/tetmesh/geometry/exact_geometry.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/sizing/sizing.hpp"
#include "tools/tetmesh/surface/crest_lines.hpp"
#include "tools/tetmesh/surface/curve_rows.hpp"
#include "tools/tetmesh/surface/delaunay_flips.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"
#include "tools/tetmesh/surface/surface_distance.hpp"
#include "tools/tetmesh/surface/surface_front.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// The longest edges of the triangles that carry the field, and of those on which rows are counted, in sizes.
constexpr double field_edge = 1.3, row_edge = 2.6;
// If the points on features are less than this share of all points on the surface, their number makes no difference.
// Organic surfaces have up to the second share, CAD has more; the bends of the first are not even.
constexpr double few_features = 0.05, features_of_cad = 0.1;
constexpr int most_parts = 64;  // of an edge, at which the size is asked for
// Flips that move the surface by less than this, in sizes, do not count as moving it.
constexpr double flatness = 1e-5;
// Points nearer than this, in sizes, to a vertex or an edge of the field's triangles become one with it.
constexpr double snap = 0.02;
// Distances are measured at points this far apart, in sizes.
constexpr double sample_spacing = 0.34;
// The share of the deviation that removing vertices may use. It measures only vertices, and some points of edges and
// faces. The chords of feature curves take no more, or vertices between their ends could not go.
constexpr double removal_share = 0.85;
// On organic surfaces faces may come this many times as far, where their corners can step out of the surface. Where
// they cannot, because it bends both ways for example, that is a fault; so not in later attempts.
constexpr double bulge_of_organic = 1.5;
constexpr int bulging_attempts = 3;
// Where the surface bends (bend_stretch.hpp), straight lines between rows of points may leave it by this share of the
// deviation. With 0.85, as much as removing vertices may use, nothing is gained: lines along a diagonal leave it by
// more.
constexpr double row_share = 0.5;
// Edges that replace others are at most this many sizes long. Diagonals of rows that stretch are 2 sizes long.
constexpr double longest_edge = 2.5;
// Features go by points that are nearer to them than this share of the deviation.
constexpr double flattest_cap = 0.1;
// A surface with this many triangles for each new one is thinned out first, within this share of the deviation; new
// edges are at most this many sizes long.
constexpr double dense = 8, thinning_share = 0.2, thin_edge = 0.7;
// Around a fault that is none of distance, the nearest vertex within this many sizes stays, unless a vertex that stays
// is as near already. If that does not help in `careful_attempts`, all triangles within that reach of any fault stay,
// and in the next attempt those within twice the reach.
constexpr double fault_reach = 0.5;
constexpr int careful_attempts = 4, most_attempts = 6;
// On the new surface; each takes about 2 KB while the surface is made.
constexpr double most_points = 2e7;
constexpr std::size_t most_seen_intersections = 1000;

void append(std::vector<Vec3>& all, const std::vector<Vec3>& some) {
  all.insert(all.end(), some.begin(), some.end());
}

bool has_within(const geometry::SizedPointGrid& grid, const Vec3& place, double reach) {
  bool found = false;
  grid.for_each_near(place, reach, 0, [&](std::int32_t i) {
    found = norm_squared(grid.points()[i] - place) <= reach * reach;
    return !found;
  });
  return found;
}

}  // namespace

class SurfaceRemesher::Work {
 public:
  Work(const solid::Surface& given, const solid::Surface& shape, const RemeshOptions& options)
      : given_(given),
        shape_(shape),
        size_(options.size),
        deviation_(options.deviation * options.unit.value_or(options.size)),
        rows_(options.rows),
        expected_points_(sizing::points_on_surface(shape, size_, most_points)),
        thinned_(thin_if_dense(shape, options.feature_angle)),
        surface_(thinned_ ? *thinned_ : shape),
        prepared_(surface_, options.feature_angle) {}

  bool make();
  bool judge();
  void follow(const RowGuide& guide);

  RemeshResult result;

 private:
  std::optional<solid::Surface> thin_if_dense(const solid::Surface& surface, double feature_angle) const;
  bool prepare();
  // False if triangles are too thin for a field.
  bool place_points();
  void place_front(const RowGuide& guide);
  double share_on_features() const;
  void remove_vertices_of_input();
  void join_points_beside_features(FeatureMesh& mesh) const;
  // Where the surface that was made is not as promised.
  struct Faults {
    std::vector<Vec3> places;
    CloseWatch too_far;
  };
  Faults find_faults();
  void measure_from_given();
  std::vector<Vec3> find_gaps() const;
  void keep_nearest(std::span<const Vec3> places, const sizing::SizeField& reach);
  void hold_around(std::span<const Vec3> places, const sizing::SizeField& reach);
  std::vector<Vertex> kept_vertices() const;
  std::size_t count_places(std::span<const Vertex> vertices) const;
  Vec3 centre_of(std::size_t triangle) const;

  // The surface, its size field and its directions, which decide where points on faces lie.
  struct Carrier {
    FeatureMesh mesh;  // with the points on features, before there are others
    std::vector<Vertex> kept;
    FieldSurface surface;
    FieldAndSides field;
    RowOptions rows;
    std::optional<CorrectedLinks> links = {};  // since the first lattice
  };

  const solid::Surface& given_;  // from which distances are reported
  const solid::Surface& shape_;  // the given one, or that without its short features
  sizing::SizeField size_, deviation_;
  RowOptions rows_;
  double bulge_ = 1;
  bool is_prepared_ = false;
  double expected_points_;  // on the new surface
  std::optional<solid::Surface> thinned_;
  const solid::Surface& surface_;  // the thinned one, or the one given
  FeatureMesh prepared_;           // with all points inserted, and with the vertices of the input
  std::optional<Carrier> carrier_;
  std::optional<DistanceIndex> input_;
  CloseWatch watch_;  // by what earlier attempts showed
};

// Scans have a hundred triangles and more for each that is needed. The field, the front and the removal of vertices
// would take them all along.
std::optional<solid::Surface> SurfaceRemesher::Work::thin_if_dense(const solid::Surface& surface,
                                                                   double feature_angle) const {
  if (static_cast<double>(surface.triangles.size()) < dense * 2 * expected_points_) return std::nullopt;
  return thin_out(surface, feature_angle, thinning_share * deviation_, thin_edge * size_);
}

bool SurfaceRemesher::Work::make() {
  if (result.attempts == most_attempts || (!is_prepared_ && !prepare())) {
    result.surface = {};
    return false;
  }
  ++result.attempts;
  remove_vertices_of_input();
  return true;
}

bool SurfaceRemesher::Work::judge() {
  const Faults faults = find_faults();
  if (result.failure.empty() && &given_ != &shape_) measure_from_given();
  const auto& [places, too_far] = faults;
  // A point may come again; that only takes time.
  append(watch_.left_behind, too_far.left_behind);
  append(watch_.strayed, too_far.strayed);
  append(watch_.other_faults, places);
  if (result.attempts < careful_attempts) {
    keep_nearest(places, fault_reach / result.attempts * size_);
  } else {
    const sizing::SizeField reach = fault_reach * (result.attempts + 1 - careful_attempts) * size_;
    for (const std::vector<Vec3>* some : {&places, &too_far.left_behind, &too_far.strayed}) hold_around(*some, reach);
  }
  return result.failure.empty();
}

bool SurfaceRemesher::Work::prepare() {
  if (!prepared_.is_manifold()) {
    result.failure = "a sheet meets itself along an edge";
    return false;
  }
  if (expected_points_ > most_points) {
    result.failure = "its size asks for more points than memory holds";
    return false;
  }
  bool placed = false;
  // This thread takes the second, whose steps the line of progress shows.
  both_at_once([&] { input_.emplace(shape_.points, shape_.triangles); }, [&] { placed = place_points(); });
  is_prepared_ = placed;
  if (!placed) result.failure = "in double precision some of its triangles have no direction";
  return placed;
}

double SurfaceRemesher::Work::share_on_features() const {
  double steps = 0;
  for (const auto e : prepared_.edges()) {
    if (!prepared_.is_feature(e)) continue;
    const auto h = prepared_.halfedge_handle(e, 0);
    const Vec3 start = prepared_.position(prepared_.from_vertex_handle(h));
    const Vec3 along = prepared_.position(prepared_.to_vertex_handle(h)) - start;
    const int parts = std::clamp(static_cast<int>(norm(along) / size_.least()), 1, size_.is_uniform() ? 1 : most_parts);
    for (int i = 0; i < parts; ++i) steps += norm(along) / parts / size_.at(start + (i + 0.5) / parts * along);
  }
  return steps / expected_points_;
}

bool SurfaceRemesher::Work::place_points() {
  if (size_.is_uniform()) prepared_.add_crests(crest_lines(prepared_, size_));
  const sizing::SizeField longest = field_edge * size_, flat = flatness * size_;
  const double on_features = share_on_features();
  // Rows end where sizes differ. Where features are few, the surface between them matters more.
  const bool counts_rows = size_.is_uniform() && on_features > few_features;
  std::optional<sizing::SizeField> chord_height;
  if (on_features <= features_of_cad)
    bulge_ = bulge_of_organic;
  else if (size_.is_uniform())
    chord_height = row_share * deviation_;
  if (counts_rows)
    sample_feature_curves(prepared_, curves_by_rows(prepared_, size_, chord_height, row_edge * size_, flat), size_,
                          removal_share * deviation_);
  else
    sample_feature_curves(prepared_, size_, removal_share * deviation_);
  refine_surface(prepared_, longest, flat);
  const std::vector<Vertex> kept = kept_vertices();
  std::optional<Step> step(std::in_place, nullptr, 0.2, 0.6);
  FieldSurface field_surface(prepared_, size_, chord_height);
  FieldAndSides field = cross_field_across(field_surface);
  if (!std::ranges::all_of(field.field.directions, is_place)) return false;
  step.reset();
  step.emplace(nullptr, 0.6, 0.8);
  carrier_.emplace(prepared_, kept, std::move(field_surface), std::move(field),
                   RowOptions{counts_rows ? rows_.stretch : 0, rows_.are_whole});
  place_front({});
  return true;
}

void SurfaceRemesher::Work::place_front(const RowGuide& guide) {
  auto& [mesh, kept, surface, field, rows, links] = *carrier_;
  if (!links) links.emplace(surface, field.field, field.opposite, kept);
  const auto [points, row_ends] = surface_front(*links, kept, size_, rows, guide);
  insert_points(prepared_, points, snap * size_);
  result.feature_points = count_places(kept);
  result.front_points = points.size();
  result.row_ends = row_ends;
}

void SurfaceRemesher::Work::follow(const RowGuide& guide) {
  result = {};
  prepared_ = carrier_->mesh;
  // What is watched stays: mostly a face strays, and leaves points behind, where the input is narrow, on any points.
  place_front(guide);
  is_prepared_ = true;
}

std::vector<Vertex> SurfaceRemesher::Work::kept_vertices() const {
  std::vector<Vertex> kept;
  for (const auto v : prepared_.vertices())
    if (prepared_.is_kept(v)) kept.push_back(v.idx());
  return kept;
}

std::size_t SurfaceRemesher::Work::count_places(std::span<const Vertex> vertices) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      vertices, [&](Vertex v) { return prepared_.place(prepared_.vertex_handle(static_cast<unsigned>(v))) == v; }));
}

void SurfaceRemesher::Work::remove_vertices_of_input() {
  const Step step(nullptr, 0.8, 1);
  FeatureMesh mesh = prepared_;
  const double bulge = result.attempts <= bulging_attempts ? bulge_ : 1;
  remove_vertices(mesh, *input_, {removal_share * deviation_, longest_edge * size_, bulge}, watch_);
  join_points_beside_features(mesh);
  result.surface = mesh.to_surface(surface_);
  result.on_feature = mesh.points_on_features();
  // A front point that comes to lie on a feature's point is one with it.
  const std::size_t placed = result.feature_points + result.front_points;
  result.extra_points = result.surface.points.size() - std::min(placed, result.surface.points.size());
}

// Not where an earlier surface had a fault, which may have come from that.
void SurfaceRemesher::Work::join_points_beside_features(FeatureMesh& mesh) const {
  geometry::SizedPointGrid faults(surface_.points.front());
  for (const std::vector<Vec3>* some : watch_.faults())
    for (const Vec3& p : *some) faults.add(p, size_.greatest());
  flip_caps(mesh, surface_, flattest_cap * deviation_, [&](HalfEdgeH h, double) {
    const Vec3 corner = mesh.position(mesh.to_vertex_handle(mesh.next_halfedge_handle(h)));
    return faults.points().empty() || !has_within(faults, corner, fault_reach * size_.at(corner));
  });
}

Vec3 SurfaceRemesher::Work::centre_of(std::size_t triangle) const {
  const auto [a, b, c] = result.surface.triangles[triangle];
  const auto& points = result.surface.points;
  return (points[a] + points[b] + points[c]) * (1.0 / 3);
}

// Edges at which the boundary of a region has a gap. Within a sheet there are none by construction.
std::vector<Vec3> SurfaceRemesher::Work::find_gaps() const {
  const solid::Surface& made = result.surface;
  std::vector<Vec3> gaps;
  if (!made.has_sheets) return gaps;
  std::vector<std::pair<std::int32_t, int>> balance;  // of the regions around an edge
  const auto add = [&](std::int32_t region, int sense) {
    for (auto& [known, sum] : balance)
      if (known == region) {
        sum += sense;
        return;
      }
    balance.emplace_back(region, sense);
  };
  geometry::for_each_edge(made.points.size(), made.triangles, [&](std::span<const geometry::HalfEdge> edge) {
    const Vertex from = geometry::start_of(made.triangles, edge[0]), to = geometry::end_of(made.triangles, edge[0]);
    balance.clear();
    for (const geometry::HalfEdge h : edge) {
      const solid::Shell& sheet = made.shells[made.shell_of[geometry::triangle_of(h)]];
      const int sense = geometry::start_of(made.triangles, h) == from ? 1 : -1;
      add(sheet.behind, sense);
      add(sheet.in_front, -sense);
    }
    if (std::ranges::any_of(balance, [](const auto& sum) { return sum.second != 0; }))
      gaps.push_back(0.5 * (made.points[from] + made.points[to]));
  });
  return gaps;
}

// By construction, the edges and vertices are manifold within each sheet and the orientation is right.
SurfaceRemesher::Work::Faults SurfaceRemesher::Work::find_faults() {
  const solid::Surface& made = result.surface;
  Faults faults;
  auto& [places, too_far] = faults;
  for (std::size_t i = 0; i < made.triangles.size(); ++i) {
    const auto [a, b, c] = made.triangles[i];
    if (geometry::are_collinear(made.points[a], made.points[b], made.points[c])) places.push_back(centre_of(i));
  }
  result.failure = "the new surface has triangles without an area";
  if (!places.empty()) return faults;
  places = find_gaps();
  result.failure = "sheets of the new surface do not meet";
  if (!places.empty()) return faults;
  // Both are measured at once, because the second is seldom measured in vain.
  SurfaceDistance there, back;
  both_at_once(
      [&] {
        const sizing::SizeField spacing = sample_spacing * size_, limit = (1 + 1e-9) * deviation_;
        const DistanceIndex output(made.points, made.triangles);
        there = one_sided_distance(made.points, made.triangles, *input_, spacing, limit);
        back = one_sided_distance(shape_.points, shape_.triangles, output, spacing, limit);
      },
      [&] {
        for (const auto& pair :
             geometry::find_intersections(made.points, made.triangles, most_seen_intersections).pairs)
          for (const std::int32_t i : pair) places.push_back(centre_of(static_cast<std::size_t>(i)));
      });
  too_far = {std::move(back.beyond), std::move(there.beyond)};
  result.failure = "the new surface intersects itself";
  if (!places.empty()) return faults;
  result.to_input = there.greatest;
  result.from_input = back.greatest;
  const bool is_near = too_far.left_behind.empty() && too_far.strayed.empty();
  result.failure = is_near ? "" : "the new surface is too far from the old one";
  return faults;
}

void SurfaceRemesher::Work::measure_from_given() {
  const sizing::SizeField spacing = sample_spacing * size_, no_limit = sizing::bounding_box_diagonal(given_);
  both_at_once(
      [&] {
        const DistanceIndex there(given_.points, given_.triangles);
        result.to_input =
            one_sided_distance(result.surface.points, result.surface.triangles, there, spacing, no_limit).greatest;
      },
      [&] {
        const DistanceIndex here(result.surface.points, result.surface.triangles);
        result.from_input = one_sided_distance(given_.points, given_.triangles, here, spacing, no_limit).greatest;
      });
}

void SurfaceRemesher::Work::keep_nearest(std::span<const Vec3> places, const sizing::SizeField& reach) {
  if (places.empty()) return;
  geometry::SizedPointGrid removable(places.front()), fresh(places.front());
  std::vector<OpenMesh::VertexHandle> handles;
  for (const auto v : prepared_.vertices()) {
    if (prepared_.is_kept(v)) continue;
    removable.add(prepared_.position(v), size_.greatest());
    handles.push_back(v);
  }
  for (const Vec3& place : places) {
    const double here = reach.at(place), size = size_.at(place);
    if (has_within(fresh, place, here)) continue;
    std::int32_t nearest = no_index;
    double least = size * size;
    removable.for_each_near(place, size, 0, [&](std::int32_t i) {
      const double distance = norm_squared(removable.points()[i] - place);
      if (distance < least) {
        least = distance;
        nearest = i;
      }
      return true;
    });
    if (nearest == no_index) continue;
    prepared_.keep(handles[nearest]);
    fresh.add(prepared_.position(handles[nearest]), reach.greatest());
  }
}

void SurfaceRemesher::Work::hold_around(std::span<const Vec3> places, const sizing::SizeField& reach) {
  if (places.empty()) return;
  geometry::SizedPointGrid grid(places.front());
  for (const Vec3& p : places) grid.add(p, reach.greatest());
  for (const auto f : prepared_.faces()) {
    const auto [a, b, c] = prepared_.positions(f);
    const Vec3 middle = (a + b + c) * (1.0 / 3);
    const double radius = std::max({norm(a - middle), norm(b - middle), norm(c - middle)});
    const double here = reach.at(middle);
    const geometry::TriangleDistance triangle(a, b, c);
    bool is_near = false;
    grid.for_each_near(middle, here + radius, 0, [&](std::int32_t i) {
      is_near = triangle.squared(grid.points()[i]) <= here * here;
      return !is_near;
    });
    if (is_near) prepared_.hold(f);
  }
}

SurfaceRemesher::SurfaceRemesher(const solid::Surface& given, const solid::Surface& shape, const RemeshOptions& options)
    : work_(new Work(given, shape, options)) {}

SurfaceRemesher::~SurfaceRemesher() = default;

bool SurfaceRemesher::make() {
  return work_->make();
}

void SurfaceRemesher::follow(const RowGuide& guide) {
  work_->follow(guide);
}

bool SurfaceRemesher::judge() {
  return work_->judge();
}

const solid::Surface& SurfaceRemesher::made() const {
  return work_->result.surface;
}

RemeshResult SurfaceRemesher::take() {
  return std::move(work_->result);
}

bool asks_for_too_many_points(const solid::Surface& surface, const sizing::SizeField& size) {
  return sizing::points_on_surface(surface, size, most_points) > most_points;
}

}  // namespace hexpipe::tetmesh::surface
