#include "tools/assemble/gap/patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/mesh/face_view.hpp"
#include "common/mesh/item_lists.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

// As in smoothing (shape/smoother.cpp): a hex counts as another cell of half its quality.
constexpr double hex_weight = 0.5;
constexpr int steps_to_make_room = 6;
// Of raise_with_neighbours(), which goes on in small steps: with least_rise a tet on bridge ends at 0.1193. With 1e-4
// it gets there, too, but more cells yield.
constexpr double small_rise = 3e-4;
// A move after which a cell is not valid is halved this often.
constexpr int retreats = 2;
// Of lower_cost(), in parts of the shortest edge.
constexpr std::array<double, 3> steps{0.3, 0.12, 0.05};
constexpr std::array<Vec3, 6> directions{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

}  // namespace

VertexMerge merge_inside(const GapMesh& gap, Vertex a, Vertex b) {
  const auto [from, into] = gap.is_inside(a) ? std::array{a, b} : std::array{b, a};
  const Vec3 at = gap.points()[into];
  return {from, into, gap.is_inside(into) ? (gap.points()[from] + at) * 0.5 : at};
}

Patch::Local Patch::local_of(Vertex v) const {
  return static_cast<Local>(std::ranges::lower_bound(vertices_, v) - vertices_.begin());
}

void Patch::add(Cell cell, std::span<const Vertex> corners) {
  std::ranges::copy(corners, cell.corners.begin());
  cells_.push_back(cell);
}

void Patch::take(std::span<const Vertex> moving, const Replacement& replacement) {
  vertices_.clear(), cells_.clear(), moving_.clear(), kept_.clear();
  graph_.reset();
  before_.assign(replacement.out.begin(), replacement.out.end());
  for (const Vertex v : moving) {
    before_.insert(before_.end(), gap_.cells_at(v).begin(), gap_.cells_at(v).end());
    for (const KeptIndex c : gap_.kept_at(v)) kept_.push_back(c);
  }
  changes_chosen_ = !replacement.merges.empty() || !replacement.come.empty();
  for (const VertexMerge& merge : replacement.merges)
    for (const Vertex v : {merge.from, merge.into})
      for (const KeptIndex c : gap_.kept_at(v)) kept_.push_back(c);
  sort_unique(before_);
  sort_unique(kept_);
  for (const GapIndex c : before_)
    if (std::ranges::find(replacement.out, c) == replacement.out.end())
      add({gap_.cell(c).kind, false, gap_.cell(c).region, std::min(gap_.cell(c).quality, floor_), {}},
          gap_.cell(c).vertices());
  for (const GapCell& cell : replacement.in)
    add({cell.kind, false, cell.region, replacement.floor, {}}, cell.vertices());
  for (const KeptIndex c : kept_) {
    if (std::ranges::find(replacement.gone, c) != replacement.gone.end()) continue;
    const KeptCell& cell = gap_.kept_cell(c);
    const double floor = cell.kind == CellKind::hex ? least_hex_quality : least_prism_quality;
    add({cell.kind, true, 0, std::min(floor, quality_of(cell.kind, gap_.points(), cell.vertices())), {}},
        cell.vertices());
    for (const VertexMerge& merge : replacement.merges)
      std::ranges::replace(cells_.back().corners, merge.from, merge.into);
  }
  for (const KeptCell& cell : replacement.come) add({cell.kind, true, 0, least_hex_quality, {}}, cell.vertices());
  for (const Cell& cell : cells_) vertices_.insert(vertices_.end(), cell.vertices().begin(), cell.vertices().end());
  vertices_.insert(vertices_.end(), moving.begin(), moving.end());
  sort_unique(vertices_);
  points_.clear();
  for (const Vertex v : vertices_) points_.push_back(gap_.points()[v]);
  for (const Vertex v : moving) moving_.push_back(local_of(v));
  fixed_.clear();
  for (const VertexMerge& merge : replacement.merges)
    if (merge.is_fixed) fixed_.push_back(local_of(merge.into));
  at_.assign(moving.size(), {});
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    for (Local& v : cells_[c].corners) v = local_of(v);
    for (std::size_t i = 0; i < moving_.size(); ++i)
      if (std::ranges::find(cells_[c].vertices(), moving_[i]) != cells_[c].vertices().end()) at_[i].push_back(c);
  }
}

double Patch::quality(const Cell& cell) const {
  return quality_of(cell.kind, points_, cell.vertices());
}

// Valid, and no prism that readers turn round.
bool Patch::is_good(const Cell& cell) const {
  const auto at = corner_points(points_, cell.vertices());
  const auto corners = std::span<const Vec3>(at).first(cell.vertices().size());
  return is_valid(cell.kind, corners) && (cell.kind != CellKind::prism || least_face_view(cell.kind, corners) > 0);
}

void Patch::look_around(std::size_t i) {
  star_.clear();
  for (const std::size_t c : at_[i]) {
    const Cell& cell = cells_[c];
    const auto at = corner_points(points_, cell.vertices());
    const auto own = static_cast<int>(std::ranges::find(cell.vertices(), moving_[i]) - cell.vertices().begin());
    shape::CornerRules rules;
    if (cell.kind == CellKind::hex) rules = shape::rules_of_hex(hex_weight);
    if (cell.is_kept && cell.kind == CellKind::prism) rules = {.floor = least_prism_quality};
    star_.add(cell.kind, std::span<const Vec3>(at).first(cell.vertices().size()), own, rules);
  }
}

bool Patch::improve(std::size_t i, double goal, double rise) {
  if (std::ranges::find(fixed_, moving_[i]) != fixed_.end()) return false;
  // Chosen cells are better: most vertices need no look at all of theirs.
  const bool is_good_here = std::ranges::all_of(at_[i], [&](std::size_t c) {
    const Cell& cell = cells_[c];
    if (cell.is_kept) return !changes_chosen_ || quality(cell) >= cell.floor;
    return quality(cell) >= goal;
  });
  if (is_good_here) return false;
  look_around(i);
  Vec3& point = points_[moving_[i]];
  const Vec3 before = point;
  const double worst = star_.worst(before);
  if (worst >= goal) return false;
  const shape::Placement place = shape::raise_worst(star_, before, steps_to_make_room);
  Vec3 step = place.at - before;
  for (int retreat = 0; retreat <= retreats; ++retreat, step *= 0.5) {
    const Vec3 at = before + step;
    if (star_.worst(at) < worst + rise || !star_.keeps_floors(before, at)) continue;
    point = at;
    if (std::ranges::all_of(at_[i], [&](std::size_t c) { return !cells_[c].is_kept || is_good(cells_[c]); }))
      return true;
    point = before;
  }
  return false;
}

void Patch::raise(double goal, int rounds) {
  double before = -1;
  for (int round = 0; round < rounds; ++round) {
    bool any = false;
    for (std::size_t i = 0; i < moving_.size(); ++i) any = improve(i, goal, least_rise) || any;
    const double now = least();
    if (!any || (now >= goal && (!changes_chosen_ || keeps_floors())) || (round > 0 && now < before + least_rise))
      return;
    before = now;
  }
}

bool Patch::raise_with_neighbours(double goal, double enough, int rounds) {
  const double most = cost_before();
  double before = least();
  bool any = true;
  for (int round = 0; round < rounds && any; ++round) {
    any = false;
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      if (!improve(i, goal, small_rise)) continue;
      any = true;
      if (least() >= enough && keeps_floors() && costs_at_most(most)) return true;
    }
    // In the first round neighbours may have begun to yield for the next.
    const double now = least();
    if (round > 0 && now <= before) break;
    before = now;
  }
  return false;
}

double Patch::hex_volume() const {
  double volume = 0;
  for (const Cell& cell : cells_)
    if (cell.is_kept && cell.kind == CellKind::hex)
      volume += cell_volume(cell.kind, corner_points(points_, cell.vertices()));
  return volume;
}

double Patch::least() const {
  double least = 1;
  for (const Cell& cell : cells_)
    if (!cell.is_kept) least = std::min(least, quality(cell));
  return least;
}

double Patch::shortest_edge() const {
  double shortest = std::numeric_limits<double>::infinity();
  for (const Cell& cell : cells_)
    with_topology(cell.kind, [&](auto topology) {
      for (const auto& [a, b] : decltype(topology)::edges)
        shortest = std::min(shortest, norm(points_[cell.corners[b]] - points_[cell.corners[a]]));
    });
  return shortest;
}

bool Patch::keeps_floors() const {
  // The quality refuses most, and takes less time.
  return std::ranges::all_of(cells_, [&](const Cell& cell) { return quality(cell) >= cell.floor; }) &&
         std::ranges::all_of(cells_, [&](const Cell& cell) { return is_good(cell); });
}

double Patch::cost_before() const {
  double cost = cost_of_faces(gap_, before_);
  for (const GapIndex c : before_) cost += cost_of(gap_.cell(c).quality);
  for (const KeptIndex c : kept_) cost += cost_of_kept_span(gap_, c);
  return cost;
}

FacesOf Patch::faces_of(const Cell& cell) const {
  FacesOf faces{cell.kind, {}, {}, cell.is_kept};
  for (std::size_t i = 0; i < cell.vertices().size(); ++i) {
    faces.corners[i] = vertices_[cell.corners[i]];
    faces.points[i] = points_[cell.corners[i]];
  }
  return faces;
}

std::vector<FacesOf> Patch::faces_of_all() const {
  std::vector<FacesOf> cells;
  cells.reserve(cells_.size());
  for (const Cell& cell : cells_) cells.push_back(faces_of(cell));
  return cells;
}

double Patch::cost_of_cells() const {
  double sum = 0;
  for (const Cell& cell : cells_)
    if (!cell.is_kept) sum += cost_of(quality(cell));
  return sum;
}

double Patch::cost() {
  const double cells = cost_of_cells();
  if (!gap_.counts_faces()) return cells;
  const std::vector<FacesOf> faces = faces_of_all();
  if (!graph_) graph_.emplace(gap_, faces, before_);
  return cells + graph_->cost(faces);
}

bool Patch::costs_at_most(double most) {
  return cost_of_cells() <= most && cost() <= most;
}

void Patch::carry_out(GapMesh& gap, const Replacement& replacement) const {
  gap.replace(replacement.out, replacement.in);
  for (const KeptIndex c : replacement.gone) gap.set_alive(c, false);
  for (const VertexMerge& merge : replacement.merges) gap.merge_kept(merge.from, merge.into);
  for (const KeptCell& cell : replacement.come) gap.add_kept(cell);
  for (const Local v : moving_) gap.relocate(vertices_[v], points_[v]);
}

double Patch::shortest_edge_at(std::size_t i) const {
  const Vec3 own = points_[moving_[i]];
  double shortest = std::numeric_limits<double>::infinity();
  const auto look = [&](bool at_kept) {
    for (const std::size_t c : at_[i]) {
      if (cells_[c].is_kept != at_kept) continue;
      for (const Local w : cells_[c].vertices())
        if (w != moving_[i]) shortest = std::min(shortest, norm(points_[w] - own));
    }
  };
  look(false);
  if (std::isinf(shortest)) look(true);
  return shortest;
}

// What the cells at a vertex cost, with their faces.
double Patch::cost_at(std::size_t i, const FaceGraph& graph, std::vector<FacesOf>& faces) const {
  double sum = 0;
  for (const std::size_t c : at_[i]) {
    faces[c] = faces_of(cells_[c]);
    if (!cells_[c].is_kept) sum += cost_of(quality(cells_[c]));
  }
  return gap_.counts_faces() ? sum + graph.cost_at(faces, at_[i]) : sum;
}

bool Patch::keeps_floors_at(std::size_t i) const {
  return std::ranges::all_of(at_[i], [&](std::size_t c) { return quality(cells_[c]) >= cells_[c].floor; }) &&
         std::ranges::all_of(at_[i], [&](std::size_t c) { return is_good(cells_[c]); });
}

double Patch::step(std::size_t i, const FaceGraph& graph, std::vector<FacesOf>& faces) {
  Vec3& point = points_[moving_[i]];
  const Vec3 start = point;
  const double length = shortest_edge_at(i), before = cost_at(i, graph, faces);
  double best = before - least_gain;
  Vec3 place = start;
  for (const double part : steps) {
    for (const Vec3& direction : directions) {
      point = start + direction * (part * length);
      if (!keeps_floors_at(i)) continue;
      if (const double now = cost_at(i, graph, faces); now < best) best = now, place = point;
    }
    if (place != start) break;
  }
  point = place;
  for (const std::size_t c : at_[i]) faces[c] = faces_of(cells_[c]);
  return place == start ? 0 : before - best;
}

double Patch::lower_cost(int rounds, std::size_t most) {
  std::vector<FacesOf> faces = faces_of_all();
  const FaceGraph graph(gap_, faces, before_);
  double gain = 0;
  for (int round = 0; round < rounds; ++round) {
    const double before = gain;
    for (std::size_t i = 0; i < std::min(most, moving_.size()); ++i) gain += step(i, graph, faces);
    if (gain == before) break;
  }
  return gain;
}

bool step_to_lower_cost(GapMesh& gap, Patch& patch, Vertex v) {
  const std::array<Vertex, 1> moving{v};
  patch.take(moving, {});
  if (patch.lower_cost(1, 1) == 0) return false;
  patch.carry_out(gap, {});
  return true;
}

}  // namespace hexpipe::assemble::gap
