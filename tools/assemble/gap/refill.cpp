// The best cells for a small room, by branch and bound: J. Liu, S. Sun, D. Wang, "Optimal tetrahedralization for small
// polyhedron: a new local transformation strategy for 3-D mesh generation and mesh improvement" (2006), with pyramids
// and prisms, and with the number of cells as what is to be small. It holds flips of all kinds, three tets to two among
// them. Cells are put on facets that still need one until none does. No two of them are tested for overlap: they are
// positive everywhere, and the signed sum of their skins is the skin of the room, so that each point of the room lies
// in exactly one of them (its winding number is 1), and none has the diagonal of a quad for its edge.

#include "tools/assemble/gap/refill.hpp"

#include <algorithm>
#include <limits>

#include "common/mesh/item_lists.hpp"
#include "common/mesh/quality.hpp"
#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

// 400 leave as many cells, and take a third longer.
constexpr int most_steps = 40;
// Part of a room's volume.
constexpr double rounding = 1e-9;
// When two of its vertices merge, most facets of a room are gone, or meet.
constexpr std::size_t most_facets_before_merge = 60;

double volume_of(const GapMesh& gap, const GapCell& cell) {
  const auto at = corner_points(gap.points(), cell.vertices());
  return cell_volume(cell.kind, std::span<const Vec3>(at).first(cell.vertices().size()));
}

// The place of four ascending corners among all fours of twelve.
constexpr std::size_t number_of(const std::array<Corner, 4>& c) {
  const std::size_t a = c[0], b = c[1], d = c[2], e = c[3];
  return a + b * (b - 1) / 2 + d * (d - 1) * (d - 2) / 6 + e * (e - 1) * (e - 2) * (e - 3) / 24;
}
static_assert(number_of({0, 1, 2, 3}) == 0 && number_of({8, 9, 10, 11}) == 494);

// The skin with `into` in place of `from`: facets that have both lose an edge, and two sides of one facet meet. Nothing
// if a facet would be there twice.
std::optional<std::vector<Facet>> merged_skin(std::span<const Facet> skin, Vertex from, Vertex into) {
  std::vector<Facet> result;
  for (const Facet& facet : skin) {
    std::vector<Vertex> corners;
    for (const Vertex v : facet.vertices())
      if (const Vertex w = v == from ? into : v; corners.empty() || corners.back() != w) corners.push_back(w);
    if (corners.front() == corners.back()) corners.pop_back();
    if (corners.size() < 3) continue;
    if (std::ranges::count(corners, into) > 1) return std::nullopt;
    const Facet moved = Facet::of(corners);
    if (std::ranges::find(result, moved) != result.end()) return std::nullopt;
    const auto twin = std::ranges::find(result, moved.reversed());
    if (twin == result.end())
      result.push_back(moved);
    else
      result.erase(twin);
  }
  return result;
}

// Inside the skin; a quad counts as the mean of its two pairs of triangles.
double volume_inside(std::span<const Vec3> points, std::span<const Facet> skin) {
  const Vec3 middle = middle_of(points, skin);
  double volume = 0;
  for (const Facet& facet : skin) {
    const auto add = [&](double share, std::size_t i, std::size_t j, std::size_t k) {
      const auto at = [&](std::size_t n) { return points[facet.corners[n]] - middle; };
      volume += share * det(at(i), at(j), at(k)) / 6;
    };
    if (!facet.is_quad())
      add(1, 0, 1, 2);
    else
      add(0.5, 0, 1, 2), add(0.5, 0, 2, 3), add(0.5, 0, 1, 3), add(0.5, 1, 2, 3);
  }
  return volume;
}

}  // namespace

void RoomCells::begin(const GapMesh& gap, std::span<const Vertex> vertices, std::int32_t region, double floor) {
  gap_ = &gap, vertices_ = vertices, region_ = region, floor_ = floor;
  ++room_;
}

std::array<Vertex, 6> RoomCells::corners_of(const SmallCell& cell) const {
  std::array<Vertex, 6> corners{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(corner_count(cell.kind)); ++i)
    corners[i] = vertices_[cell.corners[i]];
  return corners;
}

GapCell RoomCells::made_of(const SmallCell& cell) const {
  return gap_->make(cell.kind, corners_of(cell), region_);
}

// Whether readers would turn the cell round, and its volume, are asked only where it is good enough.
RoomCells::Measures RoomCells::measured(const SmallCell& small) const {
  const std::array<Vertex, 6> corners = corners_of(small);
  const auto own = std::span<const Vertex>(corners).first(static_cast<std::size_t>(corner_count(small.kind)));
  const double quality = quality_of(small.kind, gap_->points(), own);
  if (quality < floor_) return {quality, 0, 0};
  const GapCell cell = gap_->make(small.kind, corners, region_);
  return {cell.quality, volume_of(*gap_, cell), cost_of(cell.quality)};
}

// The four vertices are measured once, in ascending order: another order only turns signs round.
RoomCells::Measures RoomCells::of_tet(const SmallCell& cell) {
  std::array<Corner, 4> c{cell.corners[0], cell.corners[1], cell.corners[2], cell.corners[3]};
  bool is_turned = false;
  const auto order = [&](std::size_t i, std::size_t k) {
    if (c[i] > c[k]) std::swap(c[i], c[k]), is_turned = !is_turned;
  };
  order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
  Slot& slot = tets_[number_of(c)];
  if (slot.room != room_) {
    const GapCell made = made_of({CellKind::tet, {c[0], c[1], c[2], c[3]}});
    slot.room = room_;
    slot.measures = {made.quality, volume_of(*gap_, made), cost_of(std::abs(made.quality))};
  }
  Measures result = slot.measures;
  if (is_turned) result.quality = -result.quality, result.volume = -result.volume;
  return result;
}

RoomCells::Measures RoomCells::of(const SmallCell& cell) {
  if (cell.kind == CellKind::tet) return of_tet(cell);
  std::uint32_t key = cell.kind == CellKind::prism ? 1 : 0;
  for (const Corner c : cell.corners) key = key << 4 | c;
  Slot& slot = others_[(key * 0x9e3779b9u) >> 26];
  if (slot.room != room_ || slot.key != key) slot = {room_, key, measured(cell)};
  return slot.measures;
}

// Takes the cell into the list where no facet of it is in the front the wrong way round (there another cell is on that
// side), it is good enough, and not larger than what is left.
void Refill::offer(const SmallCell& cell, std::vector<Offer>& offers) {
  // The quality refuses most.
  const RoomCells::Measures measures = cells_.of(cell);
  if (measures.quality < floor_ || measures.volume > space_) return;
  int closes = 0;
  bool fits = true;
  for_facets(cell, [&](SmallFacet facet) {
    const bool closes_it = front_.has(facet);
    closes += closes_it ? 1 : -1;
    fits = fits && (closes_it || !front_.has(facet.reversed()));
  });
  if (fits) offers.push_back({cell, measures.cost, measures.volume, closes});
}

// On two quads of the front that have an edge in common.
void Refill::collect_prisms(SmallFacet facet, std::vector<Offer>& offers) {
  for (const SmallFacet other : front_.facets()) {
    if (!other.is_quad() || other == facet) continue;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 4; ++k) {
        auto one = [&](std::size_t n) { return facet[(i + n) % 4]; };
        auto two = [&](std::size_t n) { return other[(k + n) % 4]; };
        // Quads 0143 and 1254 of the prism.
        if (one(1) == two(0) && one(2) == two(3) && one(0) != two(1) && one(3) != two(2))
          offer({CellKind::prism, {one(0), one(1), two(1), one(3), one(2), two(2)}}, offers);
      }
  }
}

// At most about `most` of them.
void Refill::collect_offers(SmallFacet f, std::size_t most, std::vector<Offer>& offers) {
  offers.clear();
  for (Corner apex = 0; apex < room_.vertices.size(); ++apex) {
    if (offers.size() >= most) return;
    if (f.has(apex)) continue;
    if (f.is_quad())
      offer({CellKind::pyramid, {f[0], f[3], f[2], f[1], apex}}, offers);
    else
      offer({CellKind::tet, {f[0], f[2], f[1], apex}}, offers);
  }
  if (f.is_quad()) collect_prisms(f, offers);
}

// Those on the facet with the fewest choices, quads first, because what goes on them closes triangles, too; none where
// a facet has no choice.
std::vector<Refill::Offer> Refill::fewest_offers() {
  std::vector<Offer> fewest;
  if (!front_.has_room()) return fewest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const SmallFacet facet : front_.facets()) {
    if (facet.is_quad() != front_.has_quads()) continue;
    collect_offers(facet, least, offers_);
    if (offers_.size() >= least) continue;
    least = offers_.size();
    fewest.swap(offers_);
    if (least <= 1) break;
  }
  std::ranges::stable_sort(fewest, [](const Offer& a, const Offer& b) {
    return a.closes != b.closes ? a.closes > b.closes : a.cost < b.cost;
  });
  return fewest;
}

// Whether the cells that are placed are those that are there.
bool Refill::are_present() const {
  return placed_.size() == out_.size() && std::ranges::all_of(placed_, [&](const SmallCell& small) {
           const GapCell made = cells_.made_of(small);
           return std::ranges::any_of(out_, [&](GapIndex c) {
             const GapCell& cell = gap_.cell(c);
             return cell.kind == made.kind && std::ranges::is_permutation(cell.vertices(), made.vertices());
           });
         });
}

// Keeps the cells that are placed if they are the best so far. What is there is met in nearly every room, and known not
// to cost less than itself.
void Refill::compare(double cost) {
  if (!merges_ && are_present()) return;
  std::vector<GapCell> made;
  for (const SmallCell& cell : placed_) made.push_back(cells_.made_of(cell));
  const double total = merges_ ? cost : cost + cost_of_faces(gap_, made, out_);
  if (total >= most_ || std::ranges::any_of(made, [&](const GapCell& cell) { return cell.quality < floor_; })) return;
  most_ = total;
  best_ = std::move(made);
}

void Refill::try_each(const std::vector<Offer>& offers, double cost) {
  for (const Offer& offer : offers) {
    if (cost + offer.cost >= most_) continue;
    const Front front = front_;
    front_.put(offer.cell);
    placed_.push_back(offer.cell);
    space_ -= offer.volume;
    search(cost + offer.cost);
    space_ += offer.volume;
    placed_.pop_back();
    front_ = front;
  }
}

void Refill::search(double cost) {
  if (front_.empty()) return compare(cost);
  if (!front_.may_cost_less(cost, most_) || steps_left_-- <= 0) return;
  try_each(fewest_offers(), cost);
}

// False where the cells form no room, or a large one.
bool Refill::begin(std::span<const GapIndex> out) {
  auto room = room_of(gap_, out, most_facets);
  if (!room || room->vertices.size() > most_corners) return false;
  room_ = std::move(*room);
  out_ = out;
  merges_ = false;
  begin_search();
  space_ = 0;
  for (const GapIndex c : out) space_ += volume_of(gap_, gap_.cell(c));
  space_ *= 1 + rounding;
  return true;
}

void Refill::begin_search() {
  cells_.begin(gap_, room_.vertices, room_.region, floor_);
  front_ = {};
  const auto place_of = [&](Vertex v) {
    return static_cast<Corner>(std::ranges::lower_bound(room_.vertices, v) - room_.vertices.begin());
  };
  for (const Facet& facet : room_.skin) {
    const auto& f = facet.corners;
    front_.add(facet.is_quad() ? SmallFacet::of({place_of(f[0]), place_of(f[1]), place_of(f[2]), place_of(f[3])})
                               : SmallFacet::of(place_of(f[0]), place_of(f[1]), place_of(f[2])));
  }
  placed_.clear(), best_.clear();
  steps_left_ = most_steps;
}

std::optional<std::vector<GapCell>> Refill::find_merged(std::span<const GapIndex> out, Vertex from, Vertex into,
                                                        double floor, double most) {
  auto room = room_of(gap_, out, most_facets_before_merge);
  if (!room) return std::nullopt;
  auto skin = merged_skin(room->skin, from, into);
  if (!skin) return std::nullopt;
  if (skin->empty()) return std::vector<GapCell>();
  room->skin = std::move(*skin);
  room->vertices.clear();
  for (const Facet& facet : room->skin)
    room->vertices.insert(room->vertices.end(), facet.vertices().begin(), facet.vertices().end());
  sort_unique(room->vertices);
  if (room->skin.size() > most_facets || room->vertices.size() > most_corners) return std::nullopt;
  room_ = std::move(*room);
  out_ = out;
  merges_ = true;
  floor_ = floor;
  most_ = most;
  space_ = volume_inside(gap_.points(), room_.skin) * (1 + rounding);
  if (!(space_ > 0)) return std::nullopt;
  begin_search();
  const std::vector<Offer> offers = fewest_offers();
  if (!offers.empty() && front_.may_cost_less(0, most_)) try_each(offers, 0);
  if (best_.empty()) return std::nullopt;
  return best_;
}

std::optional<std::vector<GapCell>> Refill::find(std::span<const GapIndex> out) {
  const std::uint64_t state = TriedRooms::state_of(gap_, out);
  if (failed_.contains(state)) return std::nullopt;
  const Worth now = worth_of(gap_, out);
  floor_ = now.floor;
  if (begin(out)) {
    // In most rooms a facet has no choice at all: then nobody has to know what faces cost.
    const std::vector<Offer> offers = fewest_offers();
    if (!offers.empty()) {
      most_ = now.cost + cost_of_faces(gap_, out) - least_gain;
      if (front_.may_cost_less(0, most_)) try_each(offers, 0);
    }
    if (!best_.empty() && std::ranges::all_of(best_, [&](const GapCell& cell) { return is_valid(gap_, cell); }))
      return best_;
  }
  failed_.insert(state);
  return std::nullopt;
}

namespace {

// Cells around a fixed vertex may be many, and such rooms seldom have another filling.
constexpr std::size_t most_at_vertex = 20;

// With a facet in common.
bool is_beside(const GapMesh& gap, GapIndex c, GapIndex other) {
  return c != other && gap.cell(c).count_common(gap.cell(other)) >= 3;
}

}  // namespace

bool refill_around(GapMesh& gap, Refill& refill, GapIndex c) {
  const GapCell cell = gap.cell(c);
  const auto fill = [&](const std::vector<GapIndex>& room) {
    const auto in = refill.find(room);
    if (in) gap.replace(room, *in);
    return in.has_value();
  };
  std::vector<GapIndex> room{c};
  for (const Vertex v : cell.vertices())
    for (const GapIndex other : gap.cells_at(v))
      if (is_beside(gap, c, other) && std::ranges::find(room, other) == room.end()) room.push_back(other);
  if (fill(room)) return true;
  return std::ranges::any_of(cell.vertices(), [&](Vertex v) {
    room.assign(gap.cells_at(v).begin(), gap.cells_at(v).end());
    return room.size() <= most_at_vertex && fill(room);
  });
}

}  // namespace hexpipe::assemble::gap
