// A poor cell that nothing mends has too few vertices that may move. A new vertex is put into the room of the cell and
// of cells beside it, with pyramids and tets around it. If that does not help, the cell stands between hexes that may
// not become worse, and one of them gives way: its room is filled in the same manner. Where two hexes and the surface
// hold the cell from all sides, both go, one after the other. At last the room grows (wide_rooms.hpp). The cells are
// positive everywhere, and their skin is that of the room, so that they fill it and nothing else (refill.cpp).

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/item_lists.hpp"
#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/passes.hpp"
#include "tools/assemble/gap/patch.hpp"
#include "tools/assemble/gap/refill.hpp"
#include "tools/assemble/gap/skin.hpp"
#include "tools/assemble/gap/wide_rooms.hpp"

namespace hexpipe::assemble::gap {
namespace {

// So many chosen cells may go: one in 300, and one in a hundred, but at least one and at most eight. Each costs a share
// of the volume in hexes: coarse blub, of 154 hexes, lost two points with eight in any case.
constexpr std::size_t chosen_per_opened = 300, chosen_per_opened_of_few = 100, most_opened_of_few = 8;
// The same for cells that solvers refuse.
constexpr std::size_t chosen_per_refused = 1000;
// How many chosen cells around a poor one are tried, those with the most vertices of it first. Later ones seldom help.
constexpr std::size_t most_tries = 8, most_tries_of_two = 4;
constexpr int rounds_to_raise = 20;
// A new vertex that no place is better for is not tried: vertices around it cannot make that much room.
constexpr double worth_raising = 0.03;
// With more failures nobody hopes for a mesh without poor cells any more: meshes with many would take long.
constexpr std::size_t most_failures = 1;

// What filling a room has changed, so that it can be undone as long as nothing follows.
struct Filled {
  std::vector<GapIndex> out;
  GapIndex first_new = no_index;
  Vertex middle = no_index;  // the new vertex
  std::vector<Vertex> moved;
  std::vector<Vec3> places;  // before
};

// A wide room that was filled, and the chosen cells that are gone for it.
struct Widened {
  Filled filled;
  std::vector<KeptIndex> chosen;
};

class HexOpener {
 public:
  explicit HexOpener(GapMesh& gap) : gap_(gap), patch_(gap, least_wanted), refill_(gap), wide_(gap) {}

  Opened run();
  Opened run_wide();

 private:
  std::vector<KeptIndex> chosen_around(const GapCell& poor, std::size_t most) const;
  std::vector<std::vector<GapIndex>> rooms_beside(std::span<const Facet> skin, GapIndex poor) const;
  std::vector<Vertex> movable(std::span<const Facet> skin) const;
  std::optional<Filled> fill(std::vector<Facet> skin, std::span<const GapIndex> out, std::int32_t region);
  std::optional<Filled> fill_around(const Vec3& middle, std::span<const Facet> skin, std::span<const GapIndex> out,
                                    std::int32_t region);
  void undo(const Filled& filled);
  bool are_good_enough(GapIndex first_new) const;
  bool is_poor(GapIndex c) const {
    if (gap_.is_strict()) return is_refused(gap_, c);
    return gap_.is_alive(c) && gap_.cell(c).quality < least_wanted;
  }
  std::ptrdiff_t refused_at(std::span<const Vertex> vertices, GapIndex c) const;
  std::optional<Filled> fill_without_vertex(Vertex middle, GapIndex poor);
  bool fill_for(GapIndex poor, std::vector<Facet> skin, std::span<const GapIndex> out);
  bool insert(GapIndex poor);
  bool open(KeptIndex kept, GapIndex poor);
  std::vector<KeptIndex> open_one(GapIndex poor);
  std::vector<KeptIndex> open_two(GapIndex poor);
  std::vector<KeptIndex> open_for(GapIndex poor);
  bool open_wide(GapIndex poor);
  void undo_all();
  std::vector<GapIndex> poor_cells() const;

  GapMesh& gap_;
  Patch patch_;
  Refill refill_;
  WideRooms wide_;
  std::vector<Vertex> spare_;  // vertices that failed tries have left
  std::vector<Widened> done_;  // by open_wide()
};

std::vector<KeptIndex> HexOpener::chosen_around(const GapCell& poor, std::size_t most) const {
  std::vector<KeptIndex> all;
  for (const Vertex v : poor.vertices())
    for (const KeptIndex k : gap_.kept_at(v)) all.push_back(k);
  std::ranges::sort(all);
  std::vector<std::pair<std::ptrdiff_t, KeptIndex>> by_count;  // fewest common vertices last
  for (auto at = all.begin(); at != all.end();) {
    const auto end = std::ranges::find_if(at, all.end(), [&](KeptIndex k) { return k != *at; });
    if (end - at >= 2) by_count.emplace_back(at - end, *at);
    at = end;
  }
  std::ranges::sort(by_count);
  if (by_count.size() > most) by_count.resize(most);
  std::vector<KeptIndex> result;
  for (const auto& [count, k] : by_count) result.push_back(k);
  return result;
}

// Which cells of the gap to fill anew with the chosen one: none; the poor one; those that touch both; all of these.
std::vector<std::vector<GapIndex>> HexOpener::rooms_beside(std::span<const Facet> skin, GapIndex poor) const {
  std::vector<GapIndex> between;
  for (const Facet& facet : skin)
    for (const GapIndex c : gap_.cells_at(facet.corners[0])) {
      const int common = gap_.cell(c).count_common(gap_.cell(poor));
      if (c == poor || common < 2 || std::ranges::find(between, c) != between.end()) continue;
      bool touches = false;
      for_facets(gap_.cell(c).kind, gap_.cell(c).vertices(),
                 [&](const Facet& own) { touches = touches || own.reversed() == facet; });
      if (touches) between.push_back(c);
    }
  std::vector<std::vector<GapIndex>> rooms{{}, {poor}};
  if (between.empty()) return rooms;
  rooms.push_back(between);
  between.push_back(poor);
  rooms.push_back(std::move(between));
  return rooms;
}

std::vector<Vertex> HexOpener::movable(std::span<const Facet> skin) const {
  std::vector<Vertex> vertices;
  for (const Facet& facet : skin)
    for (const Vertex v : facet.vertices())
      if (gap_.is_inside(v)) vertices.push_back(v);
  sort_unique(vertices);
  return vertices;
}

bool HexOpener::are_good_enough(GapIndex first_new) const {
  for (const auto c : indices<GapIndex>(first_new, gap_.cell_count()))
    if (gap_.cell(c).quality < least_wanted || is_refused(gap_, c) || !is_valid(gap_, gap_.cell(c))) return false;
  return true;
}

// How many of c and the cells at these vertices are refused.
std::ptrdiff_t HexOpener::refused_at(std::span<const Vertex> vertices, GapIndex c) const {
  if (!gap_.is_strict()) return 0;
  std::vector<GapIndex> cells{c};
  for (const Vertex v : vertices) cells.insert(cells.end(), gap_.cells_at(v).begin(), gap_.cells_at(v).end());
  sort_unique(cells);
  return std::ranges::count_if(cells, [&](GapIndex other) { return is_refused(gap_, other); });
}

// Fills the room of the cells at the new vertex, and of the poor one, with cells that do without that vertex.
std::optional<Filled> HexOpener::fill_without_vertex(Vertex middle, GapIndex poor) {
  std::vector<GapIndex> out(gap_.cells_at(middle).begin(), gap_.cells_at(middle).end());
  if (gap_.is_alive(poor)) out.push_back(poor);
  if (!std::ranges::all_of(out, [&](GapIndex c) { return is_valid(gap_, gap_.cell(c)); })) return std::nullopt;
  const auto in = refill_.find(out);
  if (!in) return std::nullopt;
  const auto is_good = [&](const GapCell& cell) { return cell.quality >= least_wanted && is_valid(gap_, cell); };
  if (!std::ranges::all_of(*in, is_good)) return std::nullopt;
  Filled filled{out, GapIndex(gap_.cell_count()), middle, {}, {}};
  gap_.replace(out, *in);
  return filled;
}

// Fills the room within `skin` and of the cells `out` around a vertex in its middle, and moves the vertices around it.
// If cells that stay become worse than they may, everything is as before. What comes may be poor.
std::optional<Filled> HexOpener::fill(std::vector<Facet> skin, std::span<const GapIndex> out, std::int32_t region) {
  for (const GapIndex c : out) {
    if (gap_.cell(c).region != region) return std::nullopt;
    const bool begins = skin.empty();
    const Joining joining = join_skin(gap_, gap_.cell(c), skin);
    if ((!joining.touches && !begins) || joining.crosses_tagged) return std::nullopt;
  }
  if (!is_ball(skin)) return std::nullopt;
  return fill_around(middle_of(gap_.points(), skin), skin, out, region);
}

std::optional<Filled> HexOpener::fill_around(const Vec3& middle, std::span<const Facet> skin,
                                             std::span<const GapIndex> out, std::int32_t region) {
  if (spare_.empty()) spare_.push_back(gap_.add_vertex(middle));
  Filled filled{{out.begin(), out.end()}, GapIndex(gap_.cell_count()), spare_.back(), movable(skin), {}};
  spare_.pop_back();
  gap_.move(filled.middle, middle);

  std::vector<GapCell> in;
  for (const Facet& facet : skin) in.push_back(cell_on(gap_, facet, filled.middle, region));
  gap_.replace(out, in);

  filled.moved.push_back(filled.middle);
  for (const Vertex v : filled.moved) filled.places.push_back(gap_.points()[v]);
  patch_.take(filled.moved, {});
  patch_.raise(least_quality, rounds_to_raise);
  if (!patch_.keeps_floors()) {
    gap_.undo_replace(filled.out, filled.first_new);
    spare_.push_back(filled.middle);
    return std::nullopt;
  }
  patch_.carry_out(gap_, {});
  return filled;
}

void HexOpener::undo(const Filled& filled) {
  for (std::size_t i = 0; i < filled.moved.size(); ++i) gap_.relocate(filled.moved[i], filled.places[i]);
  gap_.undo_replace(filled.out, filled.first_new);
  spare_.push_back(filled.middle);
}

// Fills the room so that neither the new cells nor `poor` are poor, around a vertex or without; or changes nothing.
bool HexOpener::fill_for(GapIndex poor, std::vector<Facet> skin, std::span<const GapIndex> out) {
  const auto refused = refused_at(movable(skin), poor);
  const auto filled = fill(std::move(skin), out, gap_.cell(poor).region);
  if (!filled) return false;
  if (!is_poor(poor) && are_good_enough(filled->first_new) && refused_at(filled->moved, poor) <= refused) return true;
  if (!gap_.is_strict() && fill_without_vertex(filled->middle, poor)) {
    spare_.push_back(filled->middle);
    return true;
  }
  undo(*filled);
  return false;
}

bool HexOpener::insert(GapIndex poor) {
  for (const auto& out : rooms_around(gap_, poor))
    if (fill_for(poor, {}, out)) return true;
  return false;
}

bool HexOpener::open(KeptIndex kept, GapIndex poor) {
  if (gap_.kept_cell(kept).region != gap_.cell(poor).region) return false;
  const auto skin = skin_of(gap_, kept);
  if (!skin) return false;
  gap_.set_alive(kept, false);
  for (const auto& out : rooms_beside(*skin, poor))
    if (fill_for(poor, *skin, out)) return true;
  gap_.set_alive(kept, true);
  return false;
}

std::vector<KeptIndex> HexOpener::open_one(GapIndex poor) {
  for (const KeptIndex kept : chosen_around(gap_.cell(poor), most_tries))
    if (open(kept, poor)) return {kept};
  return {};
}

// The room of the first is filled with cells that are good enough, though `poor` stays as it is. Then there is more
// room beside it, for a vertex or for the second.
std::vector<KeptIndex> HexOpener::open_two(GapIndex poor) {
  const std::int32_t region = gap_.cell(poor).region;
  for (const KeptIndex first : chosen_around(gap_.cell(poor), most_tries_of_two)) {
    const auto skin = skin_of(gap_, first);
    if (!skin || gap_.kept_cell(first).region != region) continue;
    gap_.set_alive(first, false);
    if (const auto filled = fill(*skin, {}, region)) {
      if (are_good_enough(filled->first_new)) {
        if (insert(poor)) return {first};
        for (const KeptIndex second : chosen_around(gap_.cell(poor), most_tries_of_two))
          if (open(second, poor)) return {first, second};
      }
      undo(*filled);
    }
    gap_.set_alive(first, true);
  }
  return {};
}

std::vector<KeptIndex> HexOpener::open_for(GapIndex poor) {
  auto opened = open_one(poor);
  return opened.empty() ? open_two(poor) : opened;
}

// Puts a vertex into a wide room around the cell, and moves it to where the objective is less; or changes nothing.
bool HexOpener::open_wide(GapIndex poor) {
  const std::int32_t region = gap_.cell(poor).region;
  wide_.begin(poor);
  while (const WideRoom* room = wide_.next()) {
    if (room->worst < worth_raising) continue;
    for (const KeptIndex k : room->chosen) gap_.set_alive(k, false);
    if (auto filled = fill_around(room->at, room->skin, room->out, region)) {
      if (are_good_enough(filled->first_new)) {
        const Vertex middle = filled->middle;
        done_.push_back({std::move(*filled), room->chosen});
        if (auto without = fill_without_vertex(middle, poor))
          done_.push_back({std::move(*without), {}});
        else
          step_to_lower_cost(gap_, patch_, middle);
        return true;
      }
      undo(*filled);
    }
    for (const KeptIndex k : room->chosen) gap_.set_alive(k, true);
  }
  return false;
}

// Everything that open_wide() has done, the last first.
void HexOpener::undo_all() {
  for (; !done_.empty(); done_.pop_back()) {
    undo(done_.back().filled);
    for (const KeptIndex k : done_.back().chosen) gap_.set_alive(k, true);
  }
}

// Worst first.
std::vector<GapIndex> HexOpener::poor_cells() const {
  std::vector<GapIndex> poor;
  for (const auto c : indices<GapIndex>(gap_.cell_count()))
    if (is_poor(c)) poor.push_back(c);
  std::ranges::stable_sort(poor, {}, [&](GapIndex c) { return gap_.cell(c).quality; });
  return poor;
}

// Where one has failed, another may take it along.
Opened HexOpener::run_wide() {
  std::vector<GapIndex> poor = poor_cells();
  std::size_t failures = 0, before = poor.size() + 1;
  while (!poor.empty() && poor.size() < before && failures <= most_failures) {
    before = poor.size(), failures = 0;
    for (const GapIndex c : poor)
      if (failures <= most_failures && is_poor(c) && !open_wide(c)) ++failures;
    poor = poor_cells();
  }
  if (!poor.empty()) {
    undo_all();
    return {};
  }
  Opened result;
  result.inserted = static_cast<std::int64_t>(done_.size());
  for (const Widened& done : done_)
    for (const KeptIndex k : done.chosen) result.chosen.push_back(gap_.kept_cell(k).source);
  return result;
}

Opened HexOpener::run() {
  Opened result;
  const std::size_t kept = gap_.kept_count();
  const std::size_t of_few = std::clamp(kept / chosen_per_opened_of_few, std::size_t{1}, most_opened_of_few);
  const std::size_t most = gap_.is_strict() ? kept / chosen_per_refused : kept / chosen_per_opened + of_few;
  for (const auto c : indices<GapIndex>(gap_.cell_count())) {
    if (!is_poor(c)) continue;
    if (gap_.is_strict() && static_cast<std::size_t>(result.inserted) + result.chosen.size() >= most) break;
    if (insert(c)) {
      ++result.inserted;
      continue;
    }
    if (result.chosen.size() >= most) continue;
    for (const KeptIndex kept : open_for(c)) result.chosen.push_back(gap_.kept_cell(kept).source);
  }
  return result;
}

}  // namespace

Opened open_hexes(GapMesh& gap) {
  return HexOpener(gap).run();
}

Opened open_wide(GapMesh& gap) {
  return HexOpener(gap).run_wide();
}

}  // namespace hexpipe::assemble::gap
