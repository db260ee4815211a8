// Vertices move one by one. A vertex goes where the worst cell around it is best. If that cell is good enough, the
// vertex goes where the cells around it are better on average, hexes have more of the volume, and the worst is still
// good enough. L. A. Freitag, C. Ollivier-Gooch, "Tetrahedral mesh improvement using swapping and smoothing" (1997),
// sections 3 and 5: optimization where a smart average does not suffice. Here the average is raised along its gradient,
// because the centre of the neighbours means little to a hex. Vertices on curved surfaces step in the tangent plane and
// return to the nearest point of the input's surface. Facets between them leave it, so they move only for poor cells
// and within a bound.

#include "tools/assemble/shape/smooth.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/face_view.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/mesh/vertex_items.hpp"
#include "tools/assemble/shape/smoother.hpp"

namespace hexpipe::assemble::shape {
namespace {

// While there are poor cells, a hex of 0.1 counts as another cell of 0.025: both should reach about that.
constexpr double hex_weight_of_poor = 0.25;
// The mean counts no more than this of cells other than hexes: pyramids would grow tall and press hexes flat.
constexpr double good_beside_hexes = 0.25;
constexpr double good_prism = 0.5;
// In smooth() a prism of least_prism_quality counts as another cell that is just good enough, so that it gets room
// first. Of 2,600 prisms 450 are poorer without that and without their floors, and 6 with both; hexes have as much of
// the volume and are as good.
constexpr double prism_weight = good_enough / least_prism_quality;
// The mean scaled Jacobian of all cells at the vertex may fall by this while the hexes there grow by a hex's volume.
// Pyramids and tets become as thin as good_enough lets them, and hexes are as good as without growth. At 0.5 hexes
// are 0.02 worse on average, at 0.1 they take half as much from the tets.
constexpr double worth_of_growth = 0.2;
// A vertex stays if all its cells are at least this good. With 0.99 all the time, hexes are no better in the end than
// polishing makes them, and assemble takes 12 % longer in place of 8.
constexpr double excellent = 0.9, excellent_polished = 0.99;
// The quality of a cell and the values of its corners in a star differ by less than this.
constexpr double rounding = 1e-9;
constexpr int steps_for_worst = 8;
constexpr int steps_for_score = 2;
// Planes of a surface file are uneven by this much, in diagonals of the bounding box: such files hold floats.
constexpr double most_uneven = 5e-7;
// Scaled Jacobians do not see the length of edges: none may become shorter than this fraction of the longest at its
// vertex.
constexpr double shortest_edge = 0.1;
// A move that leaves a hex invalid is halved this often.
constexpr int retreats = 4;

}  // namespace

void Smoother::look_around(Vertex v) {
  star_.clear();
  for (std::int32_t c : cells_.at(v)) {
    const auto corners = cells_.corners_of(c);
    const auto at = corner_points(points_, corners);
    const auto moving = static_cast<int>(std::find(corners.begin(), corners.end(), v) - corners.begin());
    star_.add(cells_.kind(c), std::span<const Vec3>(at).first(corners.size()), moving, rules_of(cells_.kind(c)));
  }
}

CornerRules Smoother::rules_of(CellKind kind) const {
  switch (kind) {
    case CellKind::hex:
      return rules_of_hex(weights_.hex);
    case CellKind::prism:
      return {.weight = weights_.prism, .enough = good_prism, .floor = least_prism_quality};
    default:
      return {.enough = good_beside_hexes};
  }
}

// How much the hexes at v grow together as v moves by a unit of length, in volumes of a hex.
Vec3 Smoother::growth_at(Vertex v) const {
  Vec3 growth{};
  double volume = 0;
  int hexes = 0;
  for (std::int32_t c : cells_.at(v)) {
    if (cells_.kind(c) != CellKind::hex) continue;
    const auto corners = cells_.corners_of(c);
    const auto at = corner_points(points_, corners);
    const auto cell = std::span<const Vec3>(at).first(corners.size());
    const auto moving = static_cast<int>(std::ranges::find(corners, v) - corners.begin());
    growth += cell_volume_gradient(cells_.kind(c), cell, moving);
    volume += cell_volume(cells_.kind(c), cell);
    ++hexes;
  }
  // Among hexes alone what one gains another loses.
  const bool among_others = hexes > 0 && hexes < static_cast<int>(cells_.at(v).size());
  return among_others && volume > 0 ? growth * (hexes / volume) : Vec3{};
}

bool Smoother::is_valid_cell(std::int32_t c) const {
  const auto corners = cells_.corners_of(c);
  const auto at = corner_points(points_, corners);
  return is_valid(cells_.kind(c), std::span<const Vec3>(at).first(corners.size()));
}

bool Smoother::looks_inverted(std::int32_t c) const {
  return hexpipe::looks_inverted(cells_.kind(c), points_, cells_.corners_of(c));
}

// Whether v slides on a curved surface or curve, because it has no plane or line.
bool Smoother::slides(Vertex v) const {
  if (sliding_ == nullptr || freedoms_[v].kind != Freedom::Kind::none || sliding_->has_to_stay(v)) return false;
  const auto place = sliding_->surface.place(sliding_->origin[v]);
  return place == InputSurface::Place::face || place == InputSurface::Place::curve;
}

Freedom Smoother::freedom(Vertex v) const {
  if (!slides(v)) return freedoms_[v];
  const Vertex input = sliding_->origin[v];
  const bool on_face = sliding_->surface.place(input) == InputSurface::Place::face;
  return {on_face ? Freedom::Kind::plane : Freedom::Kind::line, sliding_->surface.foot(input, points_[v]).axis};
}

// Whether the boundary stays near enough to the input's surface if v moves to `at`.
bool Smoother::stays_close(Vertex v, const Vec3& at) {
  const double most = sliding_->surface.most_deviation_at(sliding_->origin[v]);
  const Vec3 before = std::exchange(points_[v], at);
  const double deviation = deviation_->around(v, most, most);
  points_[v] = before;
  return deviation <= most;
}

// Vertices that have slid to one side of a polygon see a plane or line that ends before them: the facets around v now
// do not tell how far the input's surface goes on.
bool Smoother::leaves_surface(Vertex v, const Vec3& at) const {
  if (sliding_ == nullptr || freedoms_[v].kind == Freedom::Kind::space) return false;
  const Vec3 foot = sliding_->surface.foot(sliding_->origin[v], at).at;
  return norm(foot - at) > most_uneven * sliding_->surface.diagonal();
}

// False if an edge at v would become shorter than the shortest is now, and short beside the longest.
bool Smoother::keeps_edges_long(Vertex v, const Vec3& at) const {
  double now = std::numeric_limits<double>::infinity(), shortest = now, longest = 0;
  for (std::int32_t c : cells_.at(v)) {
    const auto corners = cells_.corners_of(c);
    with_topology(cells_.kind(c), [&](auto topology) {
      for (const auto& e : decltype(topology)::edges) {
        if (corners[e[0]] != v && corners[e[1]] != v) continue;
        const Vec3 other = points_[corners[e[0]] == v ? corners[e[1]] : corners[e[0]]];
        now = std::min(now, norm_squared(other - points_[v]));
        shortest = std::min(shortest, norm_squared(other - at));
        longest = std::max(longest, norm_squared(other - at));
      }
    });
  }
  return shortest >= std::min(now, shortest_edge * shortest_edge * longest);
}

// By vertex: a number that its cells have, and the places of their corners.
std::vector<std::uint64_t> Smoother::states_of_vertices() const {
  std::vector<std::uint64_t> states(points_.size());
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(cells_.size()); ++c) {
    auto state = static_cast<std::uint64_t>(cells_.kind(c));
    for (const Vertex v : cells_.corners_of(c))
      for (const double x : {points_[v].x, points_[v].y, points_[v].z}) {
        state = (state ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
        state ^= state >> 32;
      }
    for (const Vertex v : cells_.corners_of(c)) states[v] += state;
  }
  return states;
}

// The least scaled Jacobian over the corners, for a tet times the square root of 2.
double Smoother::quality_of(std::int32_t c) {
  if (std::isnan(quality_[c])) quality_[c] = shape::quality_of(cells_.kind(c), points_, cells_.corners_of(c));
  return quality_[c];
}

// Whether all cells at v are above the bound. Most vertices are among hexes that are good: it would take most of the
// time to look at the corners around each of these.
bool Smoother::are_above(Vertex v, double bound, bool weighted) {
  return std::ranges::all_of(cells_.at(v), [&](std::int32_t c) {
    const double weight = weighted ? rules_of(cells_.kind(c)).weight : 1;
    return weight * quality_of(c) > bound;
  });
}

// If the worst cell, weighted by kind, is worse than the goal, vertices slide on curved surfaces. If it is better, the
// average counts, and growth.
bool Smoother::improve(Vertex v, double only_below, bool weighted, double goal, double rise) {
  if (are_above(v, only_below, weighted)) return false;
  const bool slide = slides(v);
  if (slide && are_above(v, goal + rounding, true)) return false;
  look_around(v);
  const Vec3 before = points_[v];
  star_.measure(before, before_);
  const double worst = before_.worst;
  const double worst_unweighted = before_.worst_unweighted;
  if ((weighted ? worst : worst_unweighted) > only_below) return false;
  const bool poor = worst < goal;
  if (slide && worst > goal) return false;
  if (!poor) star_.set_pull(before, worth_of_growth * growth_at(v));
  const double score = star_.score_of(before_);
  const Placement best = poor ? raise_worst(star_, before, steps_for_worst, freedom(v))
                              : raise_score(star_, before_, steps_for_score, good_enough, freedoms_[v]);
  if (best.at == before) return false;
  upright_.clear();
  for (const std::int32_t c : cells_.at(v))
    if (cells_.kind(c) == CellKind::prism && !looks_inverted(c)) upright_.push_back(c);
  valid_.assign(cells_.at(v).begin(), cells_.at(v).end());
  // Only untangle() meets invalid cells.
  if (worst <= 0) std::erase_if(valid_, [&](std::int32_t c) { return !is_valid_cell(c); });
  const double floor = poor ? worst_unweighted : std::min(worst_unweighted, good_enough);
  Vec3 step = best.at - before;
  for (int i = 0; i <= retreats; ++i, step *= 0.5) {
    const Vec3 there = before + step;
    const Vec3 at = slide ? sliding_->surface.foot(sliding_->origin[v], there).at : there;
    star_.measure(at, after_);
    if (after_.worst_unweighted < floor || !star_.keeps_floors(before_, after_)) continue;
    const bool better = poor ? after_.worst > worst + rise
                             : after_.worst >= good_enough && star_.score_of(after_) > score + least_gain_of_move;
    if (!better || leaves_surface(v, at) || (worst > 0 && !keeps_edges_long(v, at)) || (slide && !stays_close(v, at)))
      continue;
    points_[v] = at;
    if (std::ranges::all_of(valid_, [&](std::int32_t c) { return is_valid_cell(c); }) &&
        std::ranges::none_of(upright_, [&](std::int32_t c) { return looks_inverted(c); }))
      return true;
    points_[v] = before;
  }
  return false;
}

void untangle(MixedMesh& mesh, int rounds, const SlidingSurface* sliding) {
  // Hexes below 0.16 and others below 0.04: more than poor, so that the neighbours' moves do not undo it.
  constexpr double enough = 0.04;
  Smoother smoother(mesh, sliding, {.hex = hex_weight_of_poor});
  for (int round = 0; round < rounds && smoother.round(enough, true) > 0; ++round) continue;
}

namespace {

SmoothCounts run(Smoother& smoother, int rounds, double only_below) {
  SmoothCounts counts;
  for (std::int64_t moves = 1; moves > 0 && counts.rounds < rounds; ++counts.rounds) {
    moves = smoother.round(only_below, false);
    counts.moves += moves;
  }
  return counts;
}

}  // namespace

SmoothCounts smooth(MixedMesh& mesh, int rounds, const SlidingSurface* sliding, Settled* settled) {
  assert(settled == nullptr || sliding != nullptr);
  Smoother smoother(mesh, sliding, {.hex = hex_weight, .prism = prism_weight});
  if (settled != nullptr) smoother.skip(*settled);
  const SmoothCounts counts = run(smoother, rounds, excellent);
  if (settled != nullptr) smoother.remember(*settled);
  return counts;
}

SmoothCounts polish(MixedMesh& mesh, int rounds, const SlidingSurface* sliding) {
  Smoother smoother(mesh, sliding, {.hex = hex_weight});
  smoother.keep_others();
  return run(smoother, rounds, excellent_polished);
}

}  // namespace hexpipe::assemble::shape
