#include "tools/fitcad/move_boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/mesh/vertex_items.hpp"

namespace hexpipe::fitcad {
namespace {

constexpr double most_loss = 0.1;    // of the quality of cells that are poorer
constexpr double poor = 0.02;        // no cell becomes poorer than that as long as halves of quality are lost only once
constexpr int most_losses = 4;       // after that, for vertices that would still be held
constexpr int rounds_of_room = 6;    // before the boundary gives way
constexpr int rounds_inside = 3;     // of these, before vertices of the boundary slide, too
constexpr double most_slide = 0.15;  // in lengths of the edges there: longer edges leave a curved face further behind
constexpr int most_tries = 4;        // of steps of one length
constexpr double smallest_share = 0.2;

struct Cell {
  CellKind kind;
  std::array<Vertex, 8> corners;
  double first_floor = 0;
  double floor = 0;
};

class BoundaryMover {
 public:
  BoundaryMover(MixedMesh& mesh, const CadShape& shape, Targets& targets)
      : mesh_(mesh),
        shape_(shape),
        targets_(targets),
        start_(mesh.points),
        share_(mesh.points.size()),
        stays_(mesh.points.size()),
        slid_(mesh.points.size()) {
    for (const Target& target : targets.of) first_.push_back(target.at);
    add(mesh.hexes, CellKind::hex);
    add(mesh.prisms, CellKind::prism);
    add(mesh.pyramids, CellKind::pyramid);
    add(mesh.tets, CellKind::tet);
    cells_at_ = VertexItems(mesh.points.size(), [&](auto&& visit) {
      for (std::size_t i = 0; i < cells_.size(); ++i)
        for (const Vertex v : corners_of(cells_[i])) visit(v, static_cast<std::int32_t>(i));
    });
  }

  MoveCounts run() {
    for (std::size_t v = 0; v < share_.size(); ++v)
      if (!is_inside(static_cast<Vertex>(v))) set_share(static_cast<Vertex>(v), 1);
    if (!settled()) {
      lower_floors(poor);
      if (!settled()) leave_curves();
      for (int i = 0; !settled() && i < most_losses; ++i) lower_floors(0);
    }
    return counts();
  }

 private:
  template <int N>
  void add(const CellBlock<N>& block, CellKind kind) {
    for (const auto& corners : block.cells) {
      Cell cell{kind, {}};
      std::ranges::copy(corners, cell.corners.begin());
      const double quality = quality_of(cell), enough = kind == CellKind::hex ? least_hex_quality : good_enough;
      cell.first_floor = quality > enough ? enough : quality - most_loss * std::abs(quality);
      cell.floor = cell.first_floor;
      cells_.push_back(cell);
    }
  }

  static std::span<const Vertex> corners_of(const Cell& cell) {
    return std::span(cell.corners).first(static_cast<std::size_t>(corner_count(cell.kind)));
  }
  double quality_of(const Cell& cell) const {
    const auto points = corner_points(mesh_.points, corners_of(cell));
    return least_corner_scaled_jacobian(cell.kind, std::span(points).first(corners_of(cell).size()));
  }
  bool is_bad(const Cell& cell) const {
    if (quality_of(cell) < cell.floor) return true;
    const auto points = corner_points(mesh_.points, corners_of(cell));
    return !is_valid(cell.kind, std::span(points).first(corners_of(cell).size()));
  }
  bool is_inside(Vertex v) const { return targets_.of[v].place == Place::inside; }
  bool is_held(Vertex v) const { return !is_inside(v) && share_[v] < 1; }

  void set_share(Vertex v, double share) {
    share_[v] = share;
    mesh_.points[v] = share == 1 ? targets_.of[v].at : start_[v] + share * (targets_.of[v].at - start_[v]);
  }

  std::vector<std::int32_t> bad_cells() const {
    std::vector<std::int32_t> bad;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (has_moved(cells_[i]) && is_bad(cells_[i])) bad.push_back(static_cast<std::int32_t>(i));
    return bad;
  }
  bool has_moved(const Cell& cell) const {
    return std::ranges::any_of(corners_of(cell), [&](Vertex v) { return mesh_.points[v] != start_[v]; });
  }

  // How much the worst cell around a vertex is above its floor.
  double room_at(Vertex v) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::int32_t i : cells_at_.at(v)) {
      const Cell& cell = cells_[i];
      least = std::min(
          least, (quality_of(cell) - cell.floor) / (cell.kind == CellKind::hex ? least_hex_quality : good_enough));
    }
    return least;
  }

  void make_room(std::span<const std::int32_t> bad, bool slides) {
    for (const std::int32_t i : bad)
      for (const Vertex v : corners_of(cells_[i]))
        if (!stays_[v] && (is_inside(v) || (slides && may_slide(v)))) climb(v);
  }
  bool may_slide(Vertex v) const { return share_[v] == 1 && targets_.of[v].place != Place::corner; }

  // A search for a better place, along the axes and the diagonals, in steps that become smaller.
  void climb(Vertex v) {
    double length = std::numeric_limits<double>::infinity();
    for (const std::int32_t i : cells_at_.at(v))
      for (const Vertex w : corners_of(cells_[i]))
        if (w != v) length = std::min(length, norm(mesh_.points[w] - mesh_.points[v]));
    double room = room_at(v);
    for (double step = 0.1 * length; step > 0.002 * length; step /= 2)
      for (int tries = 0; tries < most_tries && climb_by(v, step, room); ++tries) {
      }
  }

  bool climb_by(Vertex v, double step, double& room) {
    const Vec3 from = mesh_.points[v];
    Vec3 best = from;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          // Along a curve or a face there are fewer ways to go.
          const int axes = std::abs(x) + std::abs(y) + std::abs(z);
          if (axes == 0 || (axes > 1 && !is_inside(v))) continue;
          const Vec3 along{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
          const Vec3 to = from + (step / norm(along)) * along;
          mesh_.points[v] = is_inside(v) ? to : targets_.slid(shape_, v, to);
          const double found = room_at(v);
          if (found <= room + 1e-9 || is_too_far(v) || !keeps_valid(v)) continue;
          room = found;
          best = mesh_.points[v];
        }
    mesh_.points[v] = best;
    if (best != from && !is_inside(v)) {
      targets_.of[v].at = best;
      slid_[v] = true;
    }
    return best != from;
  }

  bool is_too_far(Vertex v) const {
    return !is_inside(v) && norm(mesh_.points[v] - first_[v]) > most_slide * targets_.lengths[v];
  }

  // Whether all cells around a vertex that are above their floors are valid.
  bool keeps_valid(Vertex v) const {
    return std::ranges::none_of(
        cells_at_.at(v), [&](std::int32_t i) { return quality_of(cells_[i]) >= cells_[i].floor && is_bad(cells_[i]); });
  }

  // A bad cell's vertices on the boundary go back: first where they slid from, then half of the way to their start; if
  // all are where they began, those inside go back for good.
  void give_way(const Cell& cell) {
    bool is_any = false;
    for (const Vertex v : corners_of(cell)) {
      if (is_inside(v) || share_[v] == 0) continue;
      is_any = true;
      if (slid_[v])
        take_back_slide(v);
      else
        set_share(v, share_[v] > smallest_share ? share_[v] / 2 : 0);
    }
    if (is_any) return;
    for (const Vertex v : corners_of(cell)) {
      if (!is_inside(v)) continue;
      mesh_.points[v] = start_[v];
      stays_[v] = true;
    }
  }

  void take_back_slide(Vertex v) {
    slid_[v] = false;
    stays_[v] = true;
    targets_.of[v].at = first_[v];
    set_share(v, 1);
  }

  // Returns whether all vertices are where they belong.
  bool settled() {
    settle();
    return go_on();
  }

  // Makes every cell good again. Each pass takes vertices back towards their start or keeps others there, so that it
  // ends.
  void settle() {
    for (std::vector<std::int32_t> bad = bad_cells(); !bad.empty(); bad = bad_cells()) {
      for (int round = 0; round < rounds_of_room && !bad.empty(); ++round) {
        make_room(bad, round >= rounds_inside);
        bad = bad_cells();
      }
      for (const std::int32_t cell : bad) give_way(cells_[cell]);
    }
  }

  // Where vertices are held, poor cells other than hexes may become poorer, and all may try again.
  void lower_floors(double least) {
    for (Cell& cell : cells_)
      if (cell.kind != CellKind::hex && std::ranges::any_of(corners_of(cell), [&](Vertex v) { return is_held(v); }))
        cell.floor = std::min(cell.floor, std::max(least, cell.floor / 2));
    try_again();
  }

  // Held vertices may go to a face instead of a curve if no edge between tags needs the curve, and all may try again.
  void leave_curves() {
    bool is_any = false;
    for (std::size_t i = 0; i < share_.size(); ++i) {
      const auto v = static_cast<Vertex>(i);
      Target& target = targets_.of[v];
      if (!is_held(v) || target.place != Place::curve || !target.may_leave) continue;
      target = {Place::face, targets_.on_face(shape_, v, start_[v])};
      first_[v] = target.at;
      is_any = true;
    }
    if (is_any) try_again();
  }

  void try_again() {
    stays_.assign(stays_.size(), false);
    for (std::size_t v = 0; v < share_.size(); ++v)
      if (is_held(static_cast<Vertex>(v))) set_share(static_cast<Vertex>(v), 1);
  }

  // Vertices that gave way may have had no reason of their own. Returns whether none is held any more.
  bool go_on() {
    bool all = true;
    for (std::size_t i = 0; i < share_.size(); ++i) {
      const auto v = static_cast<Vertex>(i);
      if (!is_held(v)) continue;
      const double share = share_[v];
      set_share(v, 1);
      if (std::ranges::any_of(cells_at_.at(v), [&](std::int32_t c) { return is_bad(cells_[c]); })) {
        set_share(v, share);
        all = false;
      }
    }
    return all;
  }

  MoveCounts counts() const {
    MoveCounts result;
    for (std::size_t i = 0; i < share_.size(); ++i) {
      const auto v = static_cast<Vertex>(i);
      if (mesh_.points[v] != start_[v]) ++(is_inside(v) ? result.inside : result.moved);
      result.slid += slid_[v] && share_[v] == 1;
      result.held += is_held(v);
    }
    for (const Cell& cell : cells_)
      if (cell.floor < cell.first_floor) result.poorer += quality_of(cell) < std::min(poor, cell.first_floor);
    return result;
  }

  MixedMesh& mesh_;
  const CadShape& shape_;
  Targets& targets_;
  const std::vector<Vec3> start_;
  std::vector<double> share_;  // of the way to its target that a vertex of the boundary goes
  std::vector<bool> stays_;    // vertices that make no more room
  std::vector<bool> slid_;
  std::vector<Vec3> first_;  // targets before vertices slid
  std::vector<Cell> cells_;
  VertexItems cells_at_;
};

}  // namespace

MoveCounts move_boundary(MixedMesh& mesh, const CadShape& shape, Targets& targets) {
  return BoundaryMover(mesh, shape, targets).run();
}

}  // namespace hexpipe::fitcad
