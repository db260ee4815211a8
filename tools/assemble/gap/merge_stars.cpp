// The cells around two vertices are a room (skin.hpp), and all of its skin is joined to one vertex inside. The new
// cells tile the room where all of them are positive, as in refill.cpp. The place is found as in smoothing. A merge
// across a facet is a flip of two tets to three and an edge collapse in one: the flip alone would make more cells.

#include "tools/assemble/gap/passes.hpp"

#include <tsl/robin_set.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <queue>
#include <vector>

#include "common/mesh/item_lists.hpp"
#include "common/mesh/quality.hpp"
#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/objective.hpp"
#include "tools/assemble/gap/patch.hpp"
#include "tools/assemble/gap/skin.hpp"
#include "tools/assemble/shape/point_star.hpp"

namespace hexpipe::assemble::gap {
namespace {

constexpr int steps_to_merge = 8;
// A merge whose worst cell is above the first waits for vertices around it to make room, so often.
constexpr double least_to_yield = -0.1;
constexpr int rounds_to_yield = 4;
// Rooms with more facets are not merged: hardly any has a place that sees all of them.
constexpr std::size_t most_facets_of_two = 60;

struct StarMerge {
  double gain = 0;
  Vertex from = 0, into = 0;
  std::array<std::uint32_t, 2> ages{};  // of both when this was found
  Vec3 at{};
  bool yields = false;  // only where the vertices around it make room

  bool operator<(const StarMerge& other) const {
    if (yields != other.yields) return yields;
    if (gain != other.gain) return gain < other.gain;
    if (from != other.from) return from > other.from;
    return into > other.into;
  }
};

struct PairHash {
  std::size_t operator()(const std::array<std::uint64_t, 2>& pair) const {
    std::uint64_t h = (pair[0] ^ pair[1] * 0xbf58476d1ce4e5b9u) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(h ^ h >> 32);
  }
};

class StarMerger {
 public:
  StarMerger(GapMesh& gap, bool neighbours_yield) : gap_(gap), neighbours_yield_(neighbours_yield), patch_(gap) {}

  std::int64_t run() {
    for (Vertex v = 0; v < static_cast<Vertex>(gap_.vertex_count()); ++v)
      offer(v, [&](Vertex other) { return other > v; });
    std::int64_t merged = 0;
    while (!offers_.empty()) {
      const StarMerge best = offers_.top();
      offers_.pop();
      if (best.ages == std::array{gap_.age_of(best.from), gap_.age_of(best.into)}) merged += carry_out(best) ? 1 : 0;
    }
    return merged;
  }

 private:
  void collect_cells(Vertex a, Vertex b);
  std::vector<Vertex> partners_of(Vertex v) const;
  template <class Wanted>
  void offer(Vertex v, Wanted&& is_wanted);
  bool is_new(Vertex from, Vertex into);
  void offer_pair(Vertex from, Vertex into);
  void offer_around(Vertex into, const Room& room);
  bool carry_out(const StarMerge& merge);
  bool make_room(const StarMerge& merge, const Room& room);

  GapMesh& gap_;
  bool neighbours_yield_;
  Patch patch_;
  std::priority_queue<StarMerge> offers_;
  std::vector<GapIndex> cells_;
  tsl::robin_set<std::array<std::uint64_t, 2>, PairHash> seen_;  // pairs that were offered, with their ages
};

// Those at a or b.
void StarMerger::collect_cells(Vertex a, Vertex b) {
  cells_.clear();
  for (const Vertex v : {a, b}) cells_.insert(cells_.end(), gap_.cells_at(v).begin(), gap_.cells_at(v).end());
  sort_unique(cells_);
}

// Free vertices of the cells at v and of those behind their facets.
std::vector<Vertex> StarMerger::partners_of(Vertex v) const {
  std::vector<Vertex> partners;
  auto take = [&](const GapCell& cell) {
    for (const Vertex w : cell.vertices())
      if (w != v && gap_.is_free(w)) partners.push_back(w);
  };
  for (const GapIndex c : gap_.cells_at(v)) {
    const GapCell& cell = gap_.cell(c);
    take(cell);
    for (const Vertex w : cell.vertices()) {
      if (w == v) continue;
      for (const GapIndex other : gap_.cells_at(w))
        if (cell.count_common(gap_.cell(other)) >= 3) take(gap_.cell(other));
    }
  }
  sort_unique(partners);
  return partners;
}

template <class Wanted>
void StarMerger::offer(Vertex v, Wanted&& is_wanted) {
  if (!gap_.is_free(v)) return;
  for (const Vertex other : partners_of(v))
    if (is_wanted(other)) offer_pair(v, other);
}

// Both vertices of a pair offer it, and so do those around a merge: the offer is the same. A merge that was refused
// because of cells beyond the room is not tried again when only these change.
bool StarMerger::is_new(Vertex from, Vertex into) {
  const auto [a, b] = std::minmax(from, into);
  const auto with_age = [&](Vertex v) { return std::uint64_t{gap_.age_of(v)} << 32 | static_cast<std::uint32_t>(v); };
  return seen_.insert({with_age(a), with_age(b)}).second;
}

void StarMerger::offer_pair(Vertex from, Vertex into) {
  if (!is_new(from, into)) return;
  collect_cells(from, into);
  const auto room = room_of(gap_, cells_, most_facets_of_two);
  if (!room) return;
  const Worth now = worth_of(gap_, cells_);
  if (static_cast<double>(room->skin.size()) > now.cost - least_gain) return;
  shape::PointStar star;
  for (const Facet& facet : room->skin) {
    const GapCell cell = cell_on(gap_, facet, into, room->region);
    const auto at = corner_points(gap_.points(), cell.vertices());
    star.add(cell.kind, std::span<const Vec3>(at).first(cell.vertices().size()),
             static_cast<int>(cell.vertices().size()) - 1);
  }
  const Vec3 before = gap_.points()[into];
  const auto place = shape::raise_worst(star, (gap_.points()[from] + before) * 0.5, steps_to_merge);
  if (place.worst < now.floor) {
    // A merge that is far too poor has no chance.
    if (place.worst > least_to_yield && neighbours_yield_)
      offers_.push({now.cost - static_cast<double>(room->skin.size()),
                    from,
                    into,
                    {gap_.age_of(from), gap_.age_of(into)},
                    place.at,
                    true});
    return;
  }
  double after = 0;
  gap_.move(into, place.at);
  for (const Facet& facet : room->skin) after += cost_of(cell_on(gap_, facet, into, room->region).quality);
  gap_.move(into, before);
  if (now.cost - after > least_gain)
    offers_.push({now.cost - after, from, into, {gap_.age_of(from), gap_.age_of(into)}, place.at});
}

void StarMerger::offer_around(Vertex into, const Room& room) {
  auto always = [](Vertex) { return true; };
  offer(into, always);
  for (const Vertex v : room.vertices) offer(v, always);
}

// The merge with the vertices of the room moved, where that leaves no cell too poor.
bool StarMerger::make_room(const StarMerge& merge, const Room& room) {
  std::vector<GapCell> in;
  for (const Facet& facet : room.skin) in.push_back(cell_on(gap_, facet, merge.into, room.region));
  std::vector<Vertex> moving{merge.into};
  for (const Vertex v : room.vertices)
    if (gap_.is_inside(v)) moving.push_back(v);
  const Replacement replacement{cells_, in, worth_of(gap_, cells_).floor};
  patch_.take(moving, replacement);
  patch_.place(merge.into, merge.at);
  patch_.raise(least_quality, rounds_to_yield);
  if (!patch_.keeps_floors() || !patch_.costs_at_most(patch_.cost_before() - least_gain)) return false;
  patch_.carry_out(gap_, replacement);
  return true;
}

bool StarMerger::carry_out(const StarMerge& merge) {
  collect_cells(merge.from, merge.into);
  const auto room = room_of(gap_, cells_, most_facets_of_two);
  if (!room) return false;
  if (merge.yields) {
    if (!make_room(merge, *room)) return false;
    offer_around(merge.into, *room);
    return true;
  }
  const Vec3 before = gap_.points()[merge.into];
  const double faces = cost_of_faces(gap_, cells_);
  gap_.move(merge.into, merge.at);
  std::vector<GapCell> in;
  for (const Facet& facet : room->skin) in.push_back(cell_on(gap_, facet, merge.into, room->region));
  if (!std::ranges::all_of(in, [&](const GapCell& cell) { return is_valid(gap_, cell); }) ||
      cost_of_faces(gap_, in, cells_) > faces + merge.gain - least_gain) {
    gap_.move(merge.into, before);
    return false;
  }
  gap_.replace(cells_, in);
  offer_around(merge.into, *room);
  return true;
}

}  // namespace

std::int64_t merge_stars(GapMesh& gap, bool neighbours_yield) {
  return StarMerger(gap, neighbours_yield).run();
}

}  // namespace hexpipe::assemble::gap
