#include "tools/assemble/gap/wide_rooms.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::gap {
namespace {

// So many rooms are looked at around a cell, of so many facets. With 12 a cell is left on spot.
constexpr int most_rooms = 25;
constexpr std::size_t most_facets_of_wide = 40;
constexpr std::size_t most_chosen = 3, most_hexes = 1;
constexpr int steps_to_place = 8;
// Cells that are better than the worst by no more than this are among the worst, because a place is found in few steps.
constexpr double among_worst = 0.02;
// How much better the worst cell has to be for a chosen cell that goes: what is chosen is to stay.
constexpr double price_of_hex = 0.03, price_of_other = 0.01;

// The vertices of the cell on the inner side of a facet, without its last one.
std::array<Vertex, 4> base_of(const Facet& facet) {
  const auto& f = facet.corners;
  if (facet.is_quad()) return {f[0], f[3], f[2], f[1]};
  return {f[0], f[2], f[1], no_index};
}

void add(shape::PointStar& star, std::span<const Vec3> points, const Facet& facet) {
  std::array<Vec3, 5> at{};
  const auto base = base_of(facet);
  const std::size_t corners = facet.is_quad() ? 4 : 3;
  for (std::size_t i = 0; i < corners; ++i) at[i] = points[base[i]];
  star.add(facet.is_quad() ? CellKind::pyramid : CellKind::tet, std::span<const Vec3>(at).first(corners + 1),
           static_cast<int>(corners));
}

// Joins a skin to another with which it has a facet in common. False if a facet between them is tagged, or if they do
// not form a ball.
bool join_to_ball(const GapMesh& gap, std::span<const Facet> other, std::vector<Facet>& skin) {
  return !join_skin(gap, other, skin).crosses_tagged && is_ball(skin);
}

std::vector<Facet> skin_of_cell(const GapCell& cell) {
  std::vector<Facet> skin;
  for_facets(cell.kind, cell.vertices(), [&](const Facet& facet) { skin.push_back(facet); });
  return skin;
}

// A number for the cells of a room, in any order.
std::uint64_t number_of(const WideRoom& room) {
  std::uint64_t number = 0;
  const auto take = [&](std::uint64_t own) {
    own = (own ^ own >> 31) * 0x9e3779b97f4a7c15u;
    number += own ^ own >> 29;
  };
  for (const GapIndex c : room.out) take(2 * std::uint64_t{static_cast<std::uint32_t>(c)} + 1);
  for (const KeptIndex k : room.chosen) take((2 * std::uint64_t{static_cast<std::uint32_t>(k)} + 2) << 32);
  return number;
}

}  // namespace

void WideRooms::place(WideRoom& room, const Vec3& start) const {
  shape::PointStar star;
  for (const Facet& facet : room.skin) add(star, gap_.points(), facet);
  const auto placed = shape::raise_worst(star, start, steps_to_place);
  if (placed.worst > room.worst) room.at = placed.at, room.worst = placed.worst;
}

bool WideRooms::join(const WideRoom& room, const Facet& facet, WideRoom& wider) const {
  for (const GapIndex c : gap_.cells_at(facet.corners[0])) {
    if (gap_.cell(c).region != region_) continue;
    const std::vector<Facet> own = skin_of_cell(gap_.cell(c));
    if (std::ranges::find(own, facet.reversed()) == own.end()) continue;
    wider.out = room.out, wider.chosen = room.chosen, wider.skin = room.skin;
    wider.out.push_back(c);
    return join_to_ball(gap_, own, wider.skin);
  }
  return join_chosen(room, facet, wider);
}

bool WideRooms::join_chosen(const WideRoom& room, const Facet& facet, WideRoom& wider) const {
  if (room.chosen.size() >= most_chosen) return false;
  const auto hexes = static_cast<std::size_t>(
      std::ranges::count_if(room.chosen, [&](KeptIndex k) { return gap_.kept_cell(k).kind == CellKind::hex; }));
  for (const KeptIndex k : gap_.kept_at(facet.corners[0])) {
    const KeptCell& cell = gap_.kept_cell(k);
    if (cell.region != region_ || (cell.kind == CellKind::hex && hexes >= most_hexes)) continue;
    const auto own = skin_of(gap_, k);
    if (!own || std::ranges::find(*own, facet.reversed()) == own->end()) continue;
    wider.out = room.out, wider.chosen = room.chosen, wider.skin = room.skin;
    wider.chosen.push_back(k);
    return join_to_ball(gap_, *own, wider.skin);
  }
  return false;
}

void WideRooms::offer(WideRoom wider, const Vec3& start) {
  if (wider.skin.size() > most_facets_of_wide) return;
  const std::uint64_t number = number_of(wider);
  if (std::ranges::find(seen_, number) != seen_.end()) return;
  seen_.push_back(number);
  place(wider, start);
  double score = wider.worst;
  for (const KeptIndex k : wider.chosen)
    score -= gap_.kept_cell(k).kind == CellKind::hex ? price_of_hex : price_of_other;
  open_.push_back({std::move(wider), score});
  std::push_heap(open_.begin(), open_.end());
}

void WideRooms::widen(const WideRoom& room) {
  for (const Facet& facet : room.skin) {
    if (is_tagged(gap_, facet)) continue;
    shape::PointStar star;
    add(star, gap_.points(), facet);
    if (star.worst(room.at) > room.worst + among_worst) continue;
    WideRoom wider;
    if (join(room, facet, wider)) offer(std::move(wider), room.at);
  }
}

void WideRooms::begin(GapIndex poor) {
  open_.clear(), seen_.clear();
  rooms_left_ = most_rooms;
  region_ = gap_.cell(poor).region;
  current_ = WideRoom{{poor}, {}, skin_of_cell(gap_.cell(poor)), {}, 1};
  current_->at = middle_of(gap_.points(), current_->skin);
}

const WideRoom* WideRooms::next() {
  widen(*current_);
  if (open_.empty() || rooms_left_-- <= 0) return nullptr;
  std::pop_heap(open_.begin(), open_.end());
  current_ = std::move(open_.back().room);
  open_.pop_back();
  return &*current_;
}

}  // namespace hexpipe::assemble::gap
