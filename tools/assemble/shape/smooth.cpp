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
#include "tools/assemble/shape/boundary_deviation.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::shape {
namespace {

// When cells compete for a vertex, a hex of 0.5 counts as a tet or a pyramid of 0.25. Without this factor the flat
// pyramids at the border of a hex block, which cannot become much better, pull the hexes next to them down to their own
// quality (a mean of 0.92 instead of 0.96 on a block with a notch).
constexpr double hex_weight = 0.5;
// While there are poor cells, a hex of 0.1 counts as another cell of 0.025: both should reach about that.
constexpr double hex_weight_of_poor = 0.25;
// The mean counts no more than this of cells other than hexes: pyramids would grow tall and press hexes flat.
constexpr double good_beside_hexes = 0.25;
constexpr double good_prism = 0.5;
// The mean scaled Jacobian of all cells at the vertex may fall by this while the hexes there grow by a hex's volume.
// Cells between hexes become as thin as good_enough lets them, and hexes are as good as without growth. At 0.5 hexes
// are 0.02 worse on average, at 0.1 they take half as much from the tets.
constexpr double worth_of_growth = 0.2;
// If the worst cell, so weighted, is worse than this, vertices slide on curved surfaces. If it is better than
// good_enough, the average counts, and growth.
constexpr double slides_below = 0.12;
// A vertex stays if all its cells are at least this good.
constexpr double excellent = 0.9;
// The quality of a cell and the values of its corners in a star differ by less than this.
constexpr double rounding = 1e-9;
constexpr int steps_for_worst = 8;
constexpr int steps_for_score = 2;
// A smaller gain is not worth another look at the neighbours.
constexpr double least_gain_of_move = 1e-3;
// Planes of a surface file are uneven by this much, in diagonals of the bounding box: such files hold floats.
constexpr double most_uneven = 5e-7;
// Scaled Jacobians do not see the length of edges: none may become shorter than this fraction of the longest at its
// vertex.
constexpr double shortest_edge = 0.1;
// A move that leaves a hex invalid is halved this often.
constexpr int retreats = 4;

// Cells at each vertex, in flat arrays.
class Cells {
 public:
  explicit Cells(const MixedMesh& mesh) {
    auto each = [&](CellKind kind, const auto& block) {
      for (const auto& cell : block.cells) {
        kinds_.push_back(kind);
        first_.push_back(static_cast<std::int64_t>(corners_.size()));
        corners_.insert(corners_.end(), cell.begin(), cell.end());
      }
    };
    each(CellKind::hex, mesh.hexes), each(CellKind::prism, mesh.prisms);
    each(CellKind::pyramid, mesh.pyramids), each(CellKind::tet, mesh.tets);
    cells_ = VertexItems(mesh.points.size(), [&](auto&& visit) {
      for (std::int32_t c = 0; c < static_cast<std::int32_t>(kinds_.size()); ++c)
        for (Vertex v : corners_of(c)) visit(v, c);
    });
  }

  CellKind kind(std::int32_t c) const { return kinds_[c]; }
  std::span<const Vertex> corners_of(std::int32_t c) const {
    return std::span(corners_).subspan(first_[c], corner_count(kinds_[c]));
  }
  std::span<const std::int32_t> at(Vertex v) const { return cells_.at(v); }
  std::size_t size() const { return kinds_.size(); }

 private:
  std::vector<CellKind> kinds_;
  std::vector<std::int64_t> first_;
  std::vector<Vertex> corners_;
  VertexItems cells_;
};

class Smoother {
 public:
  Smoother(MixedMesh& mesh, const SlidingSurface* sliding, double weight_of_hexes)
      : weight_of_hexes_(weight_of_hexes),
        points_(mesh.points),
        cells_(mesh),
        freedoms_(vertex_freedoms(mesh)),
        due_(mesh.points.size(), 1),
        quality_(cells_.size(), unknown) {
    if (sliding == nullptr) return;
    sliding_ = sliding;
    for (Vertex v = 0; v < static_cast<Vertex>(points_.size()); ++v)
      if (sliding->has_to_stay(v)) freedoms_[v].kind = Freedom::Kind::none;
    deviation_.emplace(mesh, sliding->surface, sliding->input_points, sliding->origin);
  }

  // Returns the number of vertices that moved. Looks only at vertices whose worst cell, weighted or unweighted, is
  // below `only_below`.
  std::int64_t round(double only_below, bool weighted) {
    std::int64_t moves = 0;
    for (Vertex v = 0; v < static_cast<Vertex>(points_.size()); ++v) {
      if (!due_[v] || (freedoms_[v].kind == Freedom::Kind::none && !slides(v))) continue;
      due_[v] = 0;
      if (!improve(v, only_below, weighted)) continue;
      ++moves;
      for (std::int32_t c : cells_.at(v)) {
        quality_[c] = unknown;
        for (Vertex neighbour : cells_.corners_of(c)) due_[neighbour] = 1;
      }
    }
    return moves;
  }

  // Leaves out the vertices around which all is as it was when they settled.
  void skip(const Settled& settled) {
    const auto states = states_of_vertices();
    for (std::size_t v = 0; v < states.size(); ++v)
      if (const auto from = static_cast<std::size_t>(sliding_->origin[v]); from < settled.size())
        due_[v] = settled[from] != states[v];
  }
  void remember(Settled& settled) const {
    const auto states = states_of_vertices();
    settled.clear();
    for (std::size_t v = 0; v < states.size(); ++v) {
      const auto from = static_cast<std::size_t>(sliding_->origin[v]);
      if (from >= settled.size()) settled.resize(from + 1);
      if (due_[v] == 0) settled[from] = states[v];
    }
  }

 private:
  std::vector<std::uint64_t> states_of_vertices() const;

  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double quality_of(std::int32_t c);
  bool are_above(Vertex v, double bound, bool weighted);
  bool slides(Vertex v) const;
  Freedom freedom(Vertex v) const;
  bool stays_close(Vertex v, const Vec3& at);
  bool keeps_edges_long(Vertex v, const Vec3& at) const;
  bool leaves_surface(Vertex v, const Vec3& at) const;
  bool improve(Vertex v, double only_below, bool weighted);
  void look_around(Vertex v);
  CornerRules rules_of(CellKind kind) const;
  bool is_valid_cell(std::int32_t c) const;
  bool looks_inverted(std::int32_t c) const;
  Vec3 growth_at(Vertex v) const;

  double weight_of_hexes_;
  std::vector<Vec3>& points_;
  Cells cells_;
  std::vector<Freedom> freedoms_;
  const SlidingSurface* sliding_ = nullptr;
  std::optional<BoundaryDeviation> deviation_;
  std::vector<std::uint8_t> due_;  // something around has moved since it was looked at
  std::vector<double> quality_;    // by cell
  PointStar star_;
  // While improve() looks at a vertex: its star as it is and as it would be, and cells at it that were valid, and
  // prisms that were upright.
  PointStar::Measures before_, after_;
  std::vector<std::int32_t> valid_, upright_;
};

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
      return {.weight = weight_of_hexes_, .floor = least_hex_quality};
    case CellKind::prism:
      return {.enough = good_prism};
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
  if (std::isnan(quality_[c])) {
    const auto corners = cells_.corners_of(c);
    const auto at = corner_points(points_, corners);
    const double scale = cells_.kind(c) == CellKind::tet ? std::sqrt(2.0) : 1;
    quality_[c] = scale * least_corner_scaled_jacobian(cells_.kind(c), std::span<const Vec3>(at).first(corners.size()));
  }
  return quality_[c];
}

// Whether all cells at v are above the bound. Most vertices are among hexes that are good: it would take most of the
// time to look at the corners around each of these.
bool Smoother::are_above(Vertex v, double bound, bool weighted) {
  return std::ranges::all_of(cells_.at(v), [&](std::int32_t c) {
    const double weight = weighted && cells_.kind(c) == CellKind::hex ? weight_of_hexes_ : 1;
    return weight * quality_of(c) > bound;
  });
}

bool Smoother::improve(Vertex v, double only_below, bool weighted) {
  if (are_above(v, only_below, weighted)) return false;
  const bool slide = slides(v);
  if (slide && are_above(v, slides_below + rounding, true)) return false;
  look_around(v);
  const Vec3 before = points_[v];
  star_.measure(before, before_);
  const double worst = before_.worst;
  const double worst_unweighted = before_.worst_unweighted;
  if ((weighted ? worst : worst_unweighted) > only_below) return false;
  const bool poor = worst < good_enough;
  if (slide && worst > slides_below) return false;
  if (!poor) star_.set_pull(before, worth_of_growth * growth_at(v));
  const double score = star_.score_of(before_);
  const Placement goal = poor ? raise_worst(star_, before, steps_for_worst, freedom(v))
                              : raise_score(star_, before_, steps_for_score, good_enough, freedoms_[v]);
  if (goal.at == before) return false;
  upright_.clear();
  for (const std::int32_t c : cells_.at(v))
    if (cells_.kind(c) == CellKind::prism && !looks_inverted(c)) upright_.push_back(c);
  valid_.assign(cells_.at(v).begin(), cells_.at(v).end());
  // Only untangle() meets invalid cells.
  if (worst <= 0) std::erase_if(valid_, [&](std::int32_t c) { return !is_valid_cell(c); });
  const double floor = poor ? worst_unweighted : std::min(worst_unweighted, good_enough);
  Vec3 step = goal.at - before;
  for (int i = 0; i <= retreats; ++i, step *= 0.5) {
    const Vec3 there = before + step;
    const Vec3 at = slide ? sliding_->surface.foot(sliding_->origin[v], there).at : there;
    star_.measure(at, after_);
    if (after_.worst_unweighted < floor || !star_.keeps_floors(before_, after_)) continue;
    const bool better = poor ? after_.worst > worst + least_gain_of_move
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

}  // namespace

void untangle(MixedMesh& mesh, int rounds, const SlidingSurface* sliding) {
  // Hexes below 0.16 and others below 0.04: more than poor, so that the neighbours' moves do not undo it.
  constexpr double enough = 0.04;
  Smoother smoother(mesh, sliding, hex_weight_of_poor);
  for (int round = 0; round < rounds && smoother.round(enough, true) > 0; ++round) continue;
}

SmoothCounts smooth(MixedMesh& mesh, int rounds, const SlidingSurface* sliding, Settled* settled) {
  assert(settled == nullptr || sliding != nullptr);
  Smoother smoother(mesh, sliding, hex_weight);
  if (settled != nullptr) smoother.skip(*settled);
  SmoothCounts counts;
  for (std::int64_t moves = 1; moves > 0 && counts.rounds < rounds; ++counts.rounds) {
    moves = smoother.round(excellent, false);
    counts.moves += moves;
  }
  if (settled != nullptr) smoother.remember(*settled);
  return counts;
}

}  // namespace hexpipe::assemble::shape
