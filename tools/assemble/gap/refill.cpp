// The best cells for a small room, by branch and bound: J. Liu, S. Sun, D. Wang, "Optimal tetrahedralization for small
// polyhedron: a new local transformation strategy for 3-D mesh generation and mesh improvement" (2006), with pyramids
// and prisms, and with the number of cells as what is to be small. It holds flips of all kinds, three tets to two among
// them. Cells are put on facets that still need one until none does. No two of them are tested for overlap: they are
// positive everywhere, and the signed sum of their skins is the skin of the room, so that each point of the room lies
// in exactly one of them (its winding number is 1), and none has the diagonal of a quad for its edge.

#include "tools/assemble/gap/refill.hpp"

#include <algorithm>
#include <limits>

#include "common/mesh/quality.hpp"
#include "tools/assemble/gap/face_costs.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

// Rooms with more corners or facets take long, and seldom have a filling without a vertex inside.
constexpr std::size_t most_corners = 12;
constexpr std::size_t most_facets = 20;
// 400 leave as many cells, and take a third longer.
constexpr int most_steps = 40;
// Part of a room's volume.
constexpr double rounding = 1e-9;

double volume_of(const GapMesh& gap, const GapCell& cell) {
  const auto at = corner_points(gap.points(), cell.vertices());
  return cell_volume(cell.kind, std::span<const Vec3>(at).first(cell.vertices().size()));
}

}  // namespace

// Takes the cell into the list where it is good enough, not larger than what is left, and no facet of it is in the
// front the wrong way round: there another cell is on that side.
void Refill::offer(CellKind kind, const std::array<Vertex, 6>& corners, std::vector<Offer>& offers) const {
  Offer made;
  bool fits = true;
  for_facets(kind, corners, [&](const Facet& facet) {
    const bool closes = std::ranges::find(front_, facet) != front_.end();
    made.closes += closes ? 1 : -1;
    fits = fits && (closes || std::ranges::find(front_, facet.reversed()) == front_.end());
  });
  if (!fits) return;
  made.cell = gap_.make(kind, corners, room_.region);
  if (made.cell.quality < floor_) return;
  made.volume = volume_of(gap_, made.cell);
  if (made.volume > space_) return;
  made.cost = cost_of(made.cell.quality);
  offers.push_back(made);
}

// On two quads of the front that have an edge in common.
void Refill::collect_prisms(const Facet& facet, std::vector<Offer>& offers) const {
  for (const Facet& other : front_) {
    if (!other.is_quad() || other == facet) continue;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 4; ++k) {
        auto one = [&](std::size_t n) { return facet.corners[(i + n) % 4]; };
        auto two = [&](std::size_t n) { return other.corners[(k + n) % 4]; };
        // Quads 0143 and 1254 of the prism.
        if (one(1) == two(0) && one(2) == two(3) && one(0) != two(1) && one(3) != two(2))
          offer(CellKind::prism, {one(0), one(1), two(1), one(3), one(2), two(2)}, offers);
      }
  }
}

// At most about `most` of them.
void Refill::collect_offers(const Facet& facet, std::size_t most, std::vector<Offer>& offers) const {
  offers.clear();
  const auto& f = facet.corners;
  for (const Vertex apex : room_.vertices) {
    if (offers.size() >= most) return;
    if (std::ranges::find(f, apex) != f.end()) continue;
    if (facet.is_quad())
      offer(CellKind::pyramid, {f[0], f[3], f[2], f[1], apex}, offers);
    else
      offer(CellKind::tet, {f[0], f[2], f[1], apex}, offers);
  }
  if (facet.is_quad()) collect_prisms(facet, offers);
}

// Those on the facet with the fewest choices, quads first, because what goes on them closes triangles, too; none where
// a facet has no choice.
std::vector<Refill::Offer> Refill::fewest_offers() const {
  const bool has_quads = std::ranges::any_of(front_, &Facet::is_quad);
  std::vector<Offer> fewest, offers;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const Facet& facet : front_) {
    if (facet.is_quad() != has_quads) continue;
    collect_offers(facet, least, offers);
    if (offers.size() >= least) continue;
    least = offers.size();
    fewest.swap(offers);
    if (least <= 1) break;
  }
  std::ranges::stable_sort(fewest, [](const Offer& a, const Offer& b) {
    return a.closes != b.closes ? a.closes > b.closes : a.cost < b.cost;
  });
  return fewest;
}

void Refill::place(const Offer& offer) {
  placed_.push_back(offer.cell);
  for_facets(offer.cell.kind, offer.cell.corners, [&](const Facet& facet) {
    const auto found = std::ranges::find(front_, facet);
    if (found != front_.end())
      front_.erase(found);
    else
      front_.push_back(facet.reversed());
  });
}

void Refill::search(double cost) {
  if (front_.empty()) {
    const double total = cost + cost_of_faces(gap_, placed_, out_);
    if (total < most_) most_ = total, best_ = placed_;
    return;
  }
  const std::size_t most_closed = std::ranges::any_of(front_, &Facet::is_quad) ? 5 : 4;  // by one cell
  const auto to_come = static_cast<double>((front_.size() + most_closed - 1) / most_closed);
  if (steps_left_-- <= 0 || cost + to_come >= most_) return;
  for (const Offer& offer : fewest_offers()) {
    if (cost + offer.cost >= most_) continue;
    const std::vector<Facet> front = front_;
    place(offer);
    space_ -= offer.volume;
    search(cost + offer.cost);
    space_ += offer.volume;
    placed_.pop_back();
    front_ = front;
  }
}

std::optional<std::vector<GapCell>> Refill::find(std::span<const GapIndex> out) {
  auto room = room_of(gap_, out, most_facets);
  if (!room || room->vertices.size() > most_corners) return std::nullopt;
  room_ = std::move(*room);
  front_ = room_.skin;
  const Worth now = worth_of(gap_, out);
  out_ = out;
  floor_ = now.floor, most_ = now.cost + cost_of_faces(gap_, out) - least_gain, steps_left_ = most_steps;
  placed_.clear(), best_.clear();
  space_ = 0;
  for (const GapIndex c : out) space_ += volume_of(gap_, gap_.cell(c));
  space_ *= 1 + rounding;
  search(0);
  if (best_.empty() || !std::ranges::all_of(best_, [&](const GapCell& cell) { return is_valid(gap_, cell); }))
    return std::nullopt;
  return best_;
}

namespace {

// Cells around a fixed vertex may be many, and such rooms seldom have another filling.
constexpr std::size_t most_at_vertex = 20;

// With a facet in common.
bool is_beside(const GapMesh& gap, GapIndex c, GapIndex other) {
  return c != other &&
         std::ranges::count_if(gap.cell(c).vertices(), [&](Vertex v) { return gap.cell(other).has(v); }) >= 3;
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
