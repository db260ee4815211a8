// All vertices get a displacement: that of a tip leads to its goal, that of another vertex is the mean of its
// neighbours' (a harmonic field on the mesh's edges), so that cells far behind the wall take their part of what the
// first ones lose. Then each vertex goes a share of its way. Where a cell would become invalid or poor, its vertices go
// less far, until none does: at the start all cells are valid, so this ends. What tips lack then is tried again after
// smoothing.

#include "tools/assemble/layers/draw_back.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/mesh/face_view.hpp"
#include "common/mesh/item_lists.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/mesh/vertex_items.hpp"
#include "common/run/parallel.hpp"
#include "tools/assemble/hybrid/cell_facets.hpp"

namespace hexpipe::assemble::layers {
namespace {

constexpr int most_passes = 10, untangling_rounds = 3;
// Another pass is worth it if tips lack this share of the way somewhere...
constexpr double short_of_goal = 0.02;
// ...and the last pass has brought them on by this share of it on average.
constexpr double least_progress = 0.004;
// Each sweep carries the displacements one edge further from the wall.
constexpr int sweeps = 40;
// The shares of vertices at a cell that is not well fall by this factor; below the last one they stay where they are.
constexpr double falling = 0.7, least_share = 1e-3;
constexpr int most_steps = 80;
// After this many falls, which leave a quarter and a twentieth of the way, worse cells are well enough: a low layer
// beside a poor cell is better than none.
constexpr int first_relief = 4, last_relief = 8;
constexpr double relieved_quality = 0.6, poorest_quality = 0.01, poorest_of_sides = 0.5;
// Relief ends here, but for lines that have no length yet.
constexpr double least_hex = 0.2, least_other = 0.06;
// Along the wall, the shares of neighbours differ by no more than this.
constexpr double share_slope = 0.25;
// A cell below its limit may lose this share of its quality.
constexpr double kept_quality = 0.95;
// Cells over a sliver of the wall are slivers.
constexpr double share_of_facet_quality = 0.3;
// What cells that fan out need of what others do, beside the share of the lowest layer in the height.
constexpr double share_of_fans = 0.05;
constexpr std::int64_t grain = 256;

// The cells in flat arrays.
struct Cells {
  std::vector<CellKind> kinds;
  std::vector<std::int64_t> first;
  std::vector<Vertex> corners;
  VertexItems at_vertex;

  explicit Cells(const MixedMesh& mesh) {
    hybrid::for_each_cell(mesh, [&](CellKind kind, std::span<const Vertex> cell, std::int32_t) {
      kinds.push_back(kind);
      first.push_back(static_cast<std::int64_t>(corners.size()));
      corners.insert(corners.end(), cell.begin(), cell.end());
    });
    at_vertex = VertexItems(mesh.points.size(), [&](auto&& visit) {
      for (std::int32_t c = 0; c < static_cast<std::int32_t>(kinds.size()); ++c)
        for (const Vertex v : corners_of(c)) visit(v, c);
    });
  }
  std::span<const Vertex> corners_of(std::int64_t c) const {
    return std::span(corners).subspan(first[c], corner_count(kinds[c]));
  }
  std::int64_t count() const { return static_cast<std::int64_t>(kinds.size()); }
};

// The ends of the edges at each vertex, in flat arrays.
struct Edges {
  std::vector<std::int64_t> offsets;
  std::vector<Vertex> ends;

  explicit Edges(const Cells& cells, std::size_t points) {
    std::vector<std::array<Vertex, 2>> edges;
    for (std::int64_t c = 0; c < cells.count(); ++c) {
      const auto corners = cells.corners_of(c);
      with_topology(cells.kinds[c], [&](auto topology) {
        for (const auto& e : decltype(topology)::edges) {
          edges.push_back({corners[e[0]], corners[e[1]]});
          edges.push_back({corners[e[1]], corners[e[0]]});
        }
      });
    }
    sort_unique(edges);
    offsets.assign(points + 1, 0);
    for (const auto& edge : edges) ++offsets[edge[0] + 1], ends.push_back(edge[1]);
    for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  }
  std::span<const Vertex> of(Vertex v) const {
    return std::span(ends).subspan(offsets[v], offsets[v + 1] - offsets[v]);
  }
};

double quality_of(CellKind kind, std::span<const Vec3> corners) {
  const double scale = kind == CellKind::tet ? std::sqrt(2.0) : 1;
  return scale * least_corner_scaled_jacobian(kind, corners);
}

double least_quality_of(CellKind kind) {
  return kind == CellKind::hex ? least_hex_quality : good_enough;
}

// The least sine of an angle at a corner.
double facet_quality(const MixedMesh& mesh, const WallSide& side) {
  double least = 1;
  for (int i = 0; i < side.size(); ++i) {
    const Vec3& at = mesh.points[side.corners[i]];
    const Vec3 next = mesh.points[side.corners[(i + 1) % side.size()]] - at;
    const Vec3 last = mesh.points[side.corners[(i + side.size() - 1) % side.size()]] - at;
    least = std::min(least, norm(cross(next, last)) / (norm(next) * norm(last)));
  }
  return least;
}

class DrawBack {
 public:
  DrawBack(MixedMesh& mesh, const DrawBackInput& input)
      : mesh_(mesh),
        input_(input),
        cells_(mesh),
        edges_(cells_, mesh.points.size()),
        line_of_(mesh.points.size(), no_index),
        is_stuck_(input.walls.lines().size(), 0) {
    for (std::size_t i = 0; i < lines().size(); ++i) {
      if (lines()[i].tip == no_index) continue;
      line_of_[lines()[i].tip] = LineIndex(i);
      goals_.push_back(
          input.guides.nearest(input.plan.freedoms[i].tags, mesh.points[lines()[i].foot] + input.plan.reach[i]));
    }
    find_sides();
  }

  DrawBackResult run() {
    double before = 0;
    for (int pass = 0; pass < most_passes; ++pass) {
      find_displacements();
      step();
      if (std::vector<LineIndex> holding = holding_lines(); !holding.empty()) return {{}, std::move(holding)};
      const std::vector<double> shares = shares_gone();
      double sum = 0, least = 1;
      for (const double share : shares) sum += share, least = std::min(least, share);
      const double mean = shares.empty() ? 1 : sum / static_cast<double>(shares.size());
      if (least >= 1 - short_of_goal || mean < before + least_progress) break;
      before = mean;
      is_first_ = false;
      shape::untangle(mesh_, untangling_rounds, &input_.sliding);
      shape::smooth(mesh_, 1, &input_.sliding);
    }
    return {by_line(shares_gone()), {}};
  }

 private:
  std::span<const Line> lines() const { return input_.walls.lines(); }
  void find_sides();
  void find_displacements();
  void step();
  Vec3 place(Vertex v, double share) const;
  double relieved(double limit, double now, double floor, int round) const;
  bool is_well(std::int64_t c, int round) const;
  bool is_side_well(std::int64_t s, int round) const;
  bool grade_shares();
  std::vector<LineIndex> holding_lines() const;
  std::vector<double> shares_gone() const;
  std::vector<double> by_line(const std::vector<double>& shares) const;
  bool slides(Vertex v) const;

  MixedMesh& mesh_;
  const DrawBackInput& input_;
  const Cells cells_;
  const Edges edges_;
  std::vector<LineIndex> line_of_;  // by vertex
  std::vector<Vec3> goals_;         // by line that has a length, in their order
  std::vector<std::int32_t> long_sides_;
  VertexItems sides_at_;                // by vertex: places in long_sides_
  std::vector<double> least_of_sides_;  // the quality that the cells over each long side need
  std::vector<shape::Freedom> freedoms_;
  std::vector<Vec3> start_, displacements_;
  std::vector<double> shares_;           // by vertex
  std::vector<double> now_, least_now_;  // by cell: its quality at the start of a step, and that which it has to keep
  std::vector<std::uint8_t> is_stuck_;   // by line
  bool is_first_ = true;                 // pass
};

void DrawBack::find_sides() {
  for (std::size_t s = 0; s < input_.walls.sides().size(); ++s)
    if (layer_cell(input_.walls, input_.walls.sides()[s], 0)) {
      long_sides_.push_back(static_cast<std::int32_t>(s));
      const WallSide& side = input_.walls.sides()[s];
      // Cells that fan out from a line without length are as thin as the lowest layer is low.
      const bool fans_out = std::ranges::any_of(std::span(side.lines).first(side.size()),
                                                [&](LineIndex line) { return lines()[line].tip == no_index; });
      const double least = std::min(input_.least_quality, share_of_facet_quality * facet_quality(mesh_, side));
      least_of_sides_.push_back(fans_out ? share_of_fans * input_.places.lowest_share(side.layers) * least : least);
    }
  sides_at_ = VertexItems(mesh_.points.size(), [&](auto&& visit) {
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(long_sides_.size()); ++i) {
      const WallSide& side = input_.walls.sides()[long_sides_[i]];
      for (int k = 0; k < side.size(); ++k)
        if (const Vertex tip = lines()[side.lines[k]].tip; tip != no_index) visit(tip, i);
    }
  });
}

// Whether v is on a curved part of the boundary, where it moves along the input's surface.
bool DrawBack::slides(Vertex v) const {
  if (freedoms_[v].kind != shape::Freedom::Kind::none || line_of_[v] != no_index || input_.sliding.has_to_stay(v))
    return false;
  const auto place = input_.sliding.surface.place(input_.sliding.origin[v]);
  return place == shape::InputSurface::Place::face || place == shape::InputSurface::Place::curve;
}

void DrawBack::find_displacements() {
  const std::size_t points = mesh_.points.size();
  freedoms_ = shape::vertex_freedoms(mesh_);
  for (std::size_t v = 0; v < points; ++v) {
    const auto vertex = static_cast<Vertex>(v);
    if (input_.sliding.has_to_stay(vertex) && line_of_[v] == no_index) freedoms_[v] = {shape::Freedom::Kind::none, {}};
    if (!slides(vertex)) continue;
    const Vertex from = input_.sliding.origin[v];
    const bool on_face = input_.sliding.surface.place(from) == shape::InputSurface::Place::face;
    freedoms_[v] = {on_face ? shape::Freedom::Kind::plane : shape::Freedom::Kind::line,
                    input_.sliding.surface.foot(from, mesh_.points[v]).axis};
  }
  displacements_.assign(points, Vec3{});
  std::size_t next = 0;
  for (std::size_t i = 0; i < lines().size(); ++i)
    if (const Vertex tip = lines()[i].tip; tip != no_index) displacements_[tip] = goals_[next++] - mesh_.points[tip];
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t v = 0; v < points; ++v) {
      const auto ends = edges_.of(static_cast<Vertex>(v));
      if (line_of_[v] != no_index || freedoms_[v].kind == shape::Freedom::Kind::none || ends.empty()) continue;
      Vec3 sum{};
      for (const Vertex end : ends) sum += displacements_[end];
      displacements_[v] = freedoms_[v].allowed(sum * (1 / static_cast<double>(ends.size())));
    }
}

// Where v is after this share of its way.
Vec3 DrawBack::place(Vertex v, double share) const {
  if (share == 0 || displacements_[v] == Vec3{}) return start_[v];
  const Vec3 straight = start_[v] + displacements_[v] * share;
  if (const LineIndex line = line_of_[v]; line != no_index)
    return input_.guides.nearest(input_.plan.freedoms[line].tags, straight);
  if (freedoms_[v].kind == shape::Freedom::Kind::space) return straight;
  // Also where a plane or a straight curve may end.
  return input_.sliding.surface.foot(input_.sliding.origin[v], straight).at;
}

// The limit of a cell whose quality was `now`, after this many falls. Lines that may not leave their feet otherwise get
// relief to the last.
double DrawBack::relieved(double limit, double now, double floor, int round) const {
  if (is_first_ && round >= last_relief) return std::min({limit, relieved_quality * now, poorest_quality});
  return round >= first_relief ? std::min(limit, std::max(relieved_quality * now, floor)) : limit;
}

bool DrawBack::is_well(std::int64_t c, int round) const {
  const auto corners = cells_.corners_of(c);
  const auto at = corner_points(mesh_.points, corners);
  const auto cell = std::span<const Vec3>(at).first(corners.size());
  const CellKind kind = cells_.kinds[c];
  return quality_of(kind, cell) >=
             relieved(least_now_[c], now_[c], kind == CellKind::hex ? least_hex : least_other, round) &&
         is_valid(kind, cell) && (kind != CellKind::prism || !looks_inverted(kind, mesh_.points, corners));
}

bool DrawBack::is_side_well(std::int64_t s, int round) const {
  const WallSide& side = input_.walls.sides()[long_sides_[s]];
  const double least = is_first_ && round >= last_relief ? poorest_of_sides * least_of_sides_[s] : least_of_sides_[s];
  for (int level = 0; level < side.layers; ++level) {
    const auto cell = layer_cell(input_.walls, side, level);
    const auto at = input_.places.corners(mesh_.points, *cell);
    const auto corners = std::span<const Vec3>(at).first(corner_count(cell->kind));
    if (quality_of(cell->kind, corners) < least || !is_valid(cell->kind, corners)) return false;
  }
  return true;
}

// Lowers shares that rise steeply from a neighbour along the wall. False if there is none.
bool DrawBack::grade_shares() {
  bool any = false;
  for (const LineEdge& edge : input_.walls.edges()) {
    const Vertex a = lines()[edge.lines[0]].tip, b = lines()[edge.lines[1]].tip;
    if (a == no_index || b == no_index) continue;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      if (shares_[to] <= shares_[from] + share_slope) continue;
      shares_[to] = shares_[from] + share_slope;
      any = true;
    }
  }
  return any;
}

void DrawBack::step() {
  start_ = mesh_.points;
  shares_.assign(mesh_.points.size(), 1.0);
  now_.resize(cells_.kinds.size());
  least_now_.resize(cells_.kinds.size());
  parallel_for(cells_.count(), grain, [&](std::int64_t c) {
    const auto corners = cells_.corners_of(c);
    const auto at = corner_points(mesh_.points, corners);
    now_[c] = quality_of(cells_.kinds[c], std::span<const Vec3>(at).first(corners.size()));
    least_now_[c] = std::min(least_quality_of(cells_.kinds[c]), kept_quality * now_[c]);
  });
  // Whether something at the vertex has changed since the last look.
  std::vector<std::uint8_t> moved(mesh_.points.size(), 1);
  std::vector<std::uint8_t> poor_cell(cells_.kinds.size()), poor_side(long_sides_.size());
  const auto sides = static_cast<std::int64_t>(long_sides_.size());
  const auto is_due = [&](std::span<const Vertex> corners) {
    return std::ranges::any_of(corners, [&](Vertex v) { return moved[v] != 0; });
  };
  for (int round = 0; round < most_steps; ++round) {
    const bool is_last = round + 1 == most_steps;
    parallel_for(static_cast<std::int64_t>(mesh_.points.size()), grain, [&](std::int64_t v) {
      if (moved[v] != 0) mesh_.points[v] = place(static_cast<Vertex>(v), shares_[v]);
    });
    parallel_for(cells_.count(), grain, [&](std::int64_t c) {
      const auto corners = cells_.corners_of(c);
      const bool stands = std::ranges::all_of(corners, [&](Vertex v) { return shares_[v] == 0; });
      if (is_due(corners)) poor_cell[c] = !stands && !is_well(c, round);
    });
    parallel_for(sides, grain, [&](std::int64_t s) {
      const WallSide& side = input_.walls.sides()[long_sides_[s]];
      bool due = false, stands = true;
      for (int k = 0; k < side.size(); ++k)
        if (const Vertex tip = lines()[side.lines[k]].tip; tip != no_index)
          due = due || moved[tip] != 0, stands = stands && shares_[tip] == 0;
      // A side with a line that is stuck will have other cells.
      for (int k = 0; k < side.size(); ++k) stands = stands || is_stuck_[side.lines[k]] != 0;
      if (due) poor_side[s] = !stands && !is_side_well(s, round);
    });
    const std::vector<double> before = shares_;
    const auto fall = [&](Vertex v) {
      const double share = before[v] * falling;
      shares_[v] = is_last || share < least_share ? 0 : share;
      const LineIndex line = line_of_[v];
      if (shares_[v] == 0 && line != no_index && start_[v] == start_[lines()[line].foot]) is_stuck_[line] = 1;
    };
    for (std::int64_t c = 0; c < cells_.count(); ++c)
      if (poor_cell[c] != 0) std::ranges::for_each(cells_.corners_of(c), fall);
    for (std::int64_t s = 0; s < sides; ++s) {
      if (poor_side[s] == 0) continue;
      const WallSide& side = input_.walls.sides()[long_sides_[s]];
      for (int k = 0; k < side.size(); ++k)
        if (const Vertex tip = lines()[side.lines[k]].tip; tip != no_index) fall(tip);
    }
    if (shares_ == before) return;
    while (grade_shares()) continue;
    for (std::size_t v = 0; v < shares_.size(); ++v) moved[v] = shares_[v] != before[v];
  }
  mesh_.points = start_;
  if (!is_first_) return;
  for (std::size_t i = 0; i < lines().size(); ++i) is_stuck_[i] = lines()[i].tip != no_index;
}

// Those of the lines that are stuck that hold the others: lines beside the ends of walls if there are any.
std::vector<LineIndex> DrawBack::holding_lines() const {
  std::vector<LineIndex> stuck, result;
  for (std::size_t i = 0; i < lines().size(); ++i)
    if (is_stuck_[i] != 0) stuck.push_back(LineIndex(i));
  std::ranges::copy_if(stuck, std::back_inserter(result),
                       [&](LineIndex line) { return !lines()[line].guides.empty(); });
  return result.empty() ? stuck : result;
}

// By line with a length: the share of the way from foot to goal.
std::vector<double> DrawBack::shares_gone() const {
  std::vector<double> result;
  for (const Line& line : lines()) {
    if (line.tip == no_index) continue;
    const Vec3 way = goals_[result.size()] - mesh_.points[line.foot];
    const double square = norm_squared(way);
    result.push_back(square > 0 ? dot(mesh_.points[line.tip] - mesh_.points[line.foot], way) / square : 0);
  }
  return result;
}

std::vector<double> DrawBack::by_line(const std::vector<double>& shares) const {
  std::vector<double> result;
  std::size_t next = 0;
  for (const Line& line : lines()) result.push_back(line.tip == no_index ? 0 : shares[next++]);
  return result;
}

}  // namespace

DrawBackResult draw_back(MixedMesh& mesh, const DrawBackInput& input) {
  return DrawBack(mesh, input).run();
}

}  // namespace hexpipe::assemble::layers
