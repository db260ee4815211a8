// What checkMesh counts as wrong stops some solvers, though the cells are valid: a tet with two facets on the boundary
// has only two neighbours, whatever its shape. Mostly other cells fill the room better, or a vertex takes a few steps;
// where neither helps, a new vertex in the room gives each facet of its skin a cell of its own, which has three
// neighbours.

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "common/mesh/face_measures.hpp"
#include "common/mesh/item_lists.hpp"
#include "common/mesh/quality.hpp"
#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/passes.hpp"
#include "tools/assemble/gap/patch.hpp"
#include "tools/assemble/gap/refill.hpp"
#include "tools/assemble/gap/skin.hpp"

namespace hexpipe::assemble::gap {
namespace {

constexpr int most_passes = 3;
// Steps of a vertex take longest: only the cell's own vertices, or the new one and those next to it, take some.
constexpr std::size_t most_stepping = 5;
constexpr int rounds_of_placing = 20, rounds_of_raising = 5, rounds_of_steps = 3;
// Vertices around make room until the cells are this good: growing hexes have pressed many of them to least_quality.
constexpr double comfortable = 0.25;
// One new vertex may come for so many chosen cells, because each costs a few cells. Hexes lose no more than this share
// of their volume, most of which they take back.
constexpr std::size_t chosen_per_vertex = 300;
constexpr double share_of_volume = 2e-4;
// What a hex that goes counts in the objective, and how many are tried beside a cell.
constexpr double price_of_hex = 4;
constexpr std::size_t most_tries_of_opening = 8;

class RefusalMender {
 public:
  RefusalMender(GapMesh& gap, double floor, bool may_open)
      : gap_(gap),
        floor_(floor),
        may_open_(may_open),
        refill_(gap),
        patch_(gap, floor),
        volume_left_(share_of_volume * hex_volume_of(gap)),
        vertices_left_(gap.kept_count() / chosen_per_vertex) {}

  MendCounts run() {
    for (int pass = 0; pass < most_passes; ++pass) {
      const std::int64_t before = result_.mended;
      for (const auto k : indices<KeptIndex>(gap_.kept_count()))
        if (is_refused(k) && pass == 0) mend(k);
      // Those that come last are looked at, too.
      for (GapIndex c(0); static_cast<std::size_t>(c) < gap_.cell_count(); ++c)
        if (is_refused(c) && is_new(c)) mend(c);
      if (result_.mended == before) break;
    }
    return std::move(result_);
  }

 private:
  bool is_refused(GapIndex c) const { return gap::is_refused(gap_, c); }
  bool is_refused(KeptIndex k) const { return gap_.kept_cell(k).is_alive && cost_of_kept_span(gap_, k) > 0; }
  // Whether something around it has changed since this was asked.
  bool is_new(GapIndex c) {
    seen_.resize(gap_.cell_count(), std::numeric_limits<std::uint64_t>::max());
    return std::exchange(seen_[c], gap_.age_of_cell(c)) != gap_.age_of_cell(c);
  }
  void mend(GapIndex c);
  void mend(KeptIndex k);
  void move(std::span<const Vertex> vertices, double goal);
  void step(std::span<const Vertex> vertices);
  void move_around(GapIndex c);
  bool plan_vertex(std::vector<Facet> skin, std::span<const GapIndex> out, std::int32_t region, bool neighbours_yield);
  std::vector<std::vector<GapIndex>> rooms_beside(std::span<const Facet> skin) const;
  bool open(std::span<const KeptIndex> kept);
  bool open_with_another(KeptIndex k);
  bool insert(const std::vector<Facet>& skin, std::span<const std::vector<GapIndex>> rooms, std::int32_t region,
              double worth);

  GapMesh& gap_;
  double floor_;  // of the quality of what is not chosen
  bool may_open_;
  Refill refill_;
  Patch patch_;
  double volume_left_;                           // that hexes may still lose
  std::size_t vertices_left_;                    // that may still come
  std::vector<GapCell> in_;                      // what plan_vertex() has planned
  double volume_before_ = 0;                     // of the hexes there
  Vertex spare_ = no_index;                      // a vertex that no cell has yet
  IndexedVector<GapIndex, std::uint64_t> seen_;  // ages
  MendCounts result_;
};

// Raises the worst cells at these vertices together, if they are below the goal, and moves the vertices to where the
// objective is less.
void RefusalMender::move(std::span<const Vertex> vertices, double goal) {
  if (vertices.empty()) return;
  patch_.take(vertices, {});
  const double before = patch_.cost_before(), volume = patch_.hex_volume();
  patch_.raise(goal, rounds_of_raising);
  if (!patch_.keeps_floors()) return;
  const double cost = patch_.cost();
  if (cost - patch_.lower_cost(rounds_of_steps, most_stepping) > before - least_gain) return;
  const double lost = std::max(0.0, volume - patch_.hex_volume());
  if (lost > volume_left_) return;
  volume_left_ -= lost;
  patch_.carry_out(gap_, {});
  ++result_.mended;
}

void RefusalMender::step(std::span<const Vertex> vertices) {
  for (const Vertex v : vertices)
    if (gap_.is_inside(v)) move(std::array{v}, -1);
}

// The cell's own vertices, then those of all cells at these, too.
void RefusalMender::move_around(GapIndex c) {
  std::vector<Vertex> vertices = gap_.inner_vertices_of(c);
  move(vertices, comfortable);
  if (!is_refused(c)) return;
  for (const Vertex v : gap_.inner_vertices_around(c))
    if (!gap_.cell(c).has(v)) vertices.push_back(v);
  move(vertices, comfortable);
}

// Plans a new vertex that joins all facets around these cells and of the skin. False if there is no room for it.
bool RefusalMender::plan_vertex(std::vector<Facet> skin, std::span<const GapIndex> out, std::int32_t region,
                                bool neighbours_yield) {
  for (const GapIndex c : out) {
    if (gap_.cell(c).region != region) return false;
    const bool begins = skin.empty();
    const Joining joining = join_skin(gap_, gap_.cell(c), skin);
    if ((!joining.touches && !begins) || joining.crosses_tagged) return false;
  }
  if (!is_ball(skin)) return false;
  Vec3 middle{};
  double corners = 0;
  for (const Facet& facet : skin)
    for (const Vertex v : facet.vertices()) middle += gap_.points()[v], ++corners;
  middle *= 1 / corners;
  if (spare_ == no_index) spare_ = gap_.add_vertex(middle);
  gap_.move(spare_, middle);
  std::vector<Vertex> moving{spare_};
  in_.clear();
  for (const Facet& facet : skin) {
    in_.push_back(cell_on(gap_, facet, spare_, region));
    for (const Vertex v : facet.vertices())
      if (neighbours_yield && gap_.is_inside(v) && std::ranges::find(moving, v) == moving.end()) moving.push_back(v);
  }
  patch_.take(moving, {out, in_, std::min(floor_, worth_of(gap_, out).floor)});
  volume_before_ = patch_.hex_volume();
  patch_.raise(neighbours_yield ? comfortable : 1, rounds_of_placing);
  return patch_.keeps_floors();
}

// Puts a vertex into the one of these rooms, each with the skin, where the objective falls most.
bool RefusalMender::insert(const std::vector<Facet>& skin, std::span<const std::vector<GapIndex>> rooms,
                           std::int32_t region, double worth) {
  if (vertices_left_ == 0) return false;
  for (const bool neighbours_yield : {false, true}) {
    double best = least_gain;
    const std::vector<GapIndex>* room = nullptr;
    for (const auto& out : rooms) {
      if (!plan_vertex(skin, out, region, neighbours_yield)) continue;
      const double planned = patch_.cost_before() + worth - patch_.cost();
      const double gain = planned + patch_.lower_cost(rounds_of_steps, most_stepping);
      if (gain > best && volume_before_ - patch_.hex_volume() <= volume_left_) best = gain, room = &out;
    }
    if (room == nullptr) continue;
    plan_vertex(skin, *room, region, neighbours_yield);
    patch_.lower_cost(rounds_of_steps, most_stepping);
    volume_left_ -= std::max(0.0, volume_before_ - patch_.hex_volume());
    patch_.carry_out(gap_, {*room, in_, 0});
    spare_ = no_index;
    --vertices_left_;
    ++result_.mended;
    return true;
  }
  return false;
}

void RefusalMender::mend(GapIndex c) {
  const GapCell cell = gap_.cell(c);
  step(cell.vertices());
  if (is_refused(c)) result_.mended += refill_around(gap_, refill_, c);
  if (is_refused(c)) move_around(c);
  if (!is_refused(c)) return;
  auto rooms = rooms_around(gap_, c);
  rooms.insert(rooms.begin(), {c});
  insert({}, rooms, cell.region, 0);
}

// The cells of the gap that touch the skin from outside, each as a room, after one without any.
std::vector<std::vector<GapIndex>> RefusalMender::rooms_beside(std::span<const Facet> skin) const {
  std::vector<std::vector<GapIndex>> rooms{{}};
  for (const Facet& facet : skin)
    for (const GapIndex c : gap_.cells_at(facet.corners[0])) {
      bool touches = false;
      for_facets(gap_.cell(c).kind, gap_.cell(c).vertices(),
                 [&](const Facet& own) { touches = touches || own.reversed() == facet; });
      if (touches && std::ranges::find(rooms, std::vector{c}) == rooms.end()) rooms.push_back({c});
    }
  return rooms;
}

// Puts a vertex into the room of these chosen cells, alone or with a cell of the gap.
bool RefusalMender::open(std::span<const KeptIndex> kept) {
  std::vector<Facet> skin;
  const std::int32_t region = gap_.kept_cell(kept.front()).region;
  for (const KeptIndex k : kept) {
    const auto own = skin_of(gap_, k);
    if (!own || gap_.kept_cell(k).region != region) return false;
    const std::size_t before = skin.size();
    for (const Facet& facet : *own) {
      const auto twin = std::ranges::find(skin, facet.reversed());
      if (twin == skin.end())
        skin.push_back(facet);
      else
        skin.erase(twin);
    }
    if (before > 0 && skin.size() == before + own->size()) return false;
  }
  double worth = 0, volume = 0;
  for (const KeptIndex k : kept) {
    const KeptCell& cell = gap_.kept_cell(k);
    worth += cost_of_kept_span(gap_, k);
    if (cell.kind != CellKind::hex) continue;
    worth -= price_of_hex;
    volume += cell_volume(cell.kind, corner_points(gap_.points(), cell.vertices()));
  }
  if (volume > volume_left_) return false;
  for (const KeptIndex k : kept) gap_.set_alive(k, false);
  const bool done = insert(skin, rooms_beside(skin), region, worth);
  if (done) volume_left_ -= volume;
  for (const KeptIndex k : kept)
    if (done)
      result_.opened.push_back(gap_.kept_cell(k).source);
    else
      gap_.set_alive(k, true);
  return done;
}

// The refused cell goes with one of the chosen cells beside it: those with most of its vertices first.
bool RefusalMender::open_with_another(KeptIndex k) {
  const KeptCell cell = gap_.kept_cell(k);
  const auto vertices = cell.vertices();
  std::vector<KeptIndex> all;
  for (const Vertex v : vertices)
    for (const KeptIndex other : gap_.kept_at(v))
      if (other != k) all.push_back(other);
  sort_unique(all);
  std::vector<std::pair<std::ptrdiff_t, KeptIndex>> beside;  // fewest common vertices last
  for (const KeptIndex other : all) {
    const auto own = gap_.kept_cell(other).vertices();
    const auto common =
        std::ranges::count_if(own, [&](Vertex v) { return std::ranges::find(vertices, v) != vertices.end(); });
    if (common >= 2) beside.emplace_back(-common, other);
  }
  std::ranges::sort(beside);
  if (beside.size() > most_tries_of_opening) beside.resize(most_tries_of_opening);
  return std::ranges::any_of(beside, [&](const auto& at) { return open(std::array{k, at.second}); });
}

// A prism or pyramid that no step mends goes, too, alone or with a hex beside it.
void RefusalMender::mend(KeptIndex k) {
  const KeptCell cell = gap_.kept_cell(k);
  step(cell.vertices());
  if (!is_refused(k) || !may_open_ || open(std::array{k})) return;
  open_with_another(k);
}

}  // namespace

bool has_refused_hex(const GapMesh& gap) {
  for (const auto k : indices<KeptIndex>(gap.kept_count())) {
    const KeptCell& cell = gap.kept_cell(k);
    if (!cell.is_alive || cell.kind != CellKind::hex) continue;
    std::array<std::uint8_t, 6> inner{};
    for (int i = 0; i < 6; ++i) inner[static_cast<std::size_t>(i)] = gap.has_partner(k, i) ? 1 : 0;
    if (std::ranges::count(inner, 1) <= 4 &&
        cell_determinant(cell.kind, corner_points(gap.points(), cell.vertices()), inner) < low_determinant)
      return true;
  }
  return false;
}

std::int64_t count_refused(const GapMesh& gap) {
  std::int64_t count = 0;
  for (const auto k : indices<KeptIndex>(gap.kept_count()))
    count += gap.kept_cell(k).is_alive && cost_of_kept_span(gap, k) > 0;
  for (const auto c : indices<GapIndex>(gap.cell_count())) count += is_refused(gap, c);
  return count;
}

MendCounts mend_refused(GapMesh& gap) {
  return RefusalMender(gap, least_quality, false).run();
}

MendCounts open_for_refused(GapMesh& gap) {
  MendCounts counts = RefusalMender(gap, least_wanted, true).run();
  const Opened opened = open_hexes(gap);
  if (opened.inserted == 0 && opened.chosen.empty()) return counts;
  const MendCounts again = RefusalMender(gap, least_wanted, true).run();
  counts.mended += opened.inserted + again.mended;
  for (const auto& more : {opened.chosen, again.opened})
    counts.opened.insert(counts.opened.end(), more.begin(), more.end());
  return counts;
}

}  // namespace hexpipe::assemble::gap
