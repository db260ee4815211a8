// The new cells have the skin that the map of the merges leaves of the old ones: maps of vertices and boundaries
// commute. All of them are positive everywhere, so that they tile what was tiled before (close_gaps.cpp).

#include "tools/assemble/gap/reshape.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "common/mesh/item_lists.hpp"
#include "common/mesh/quality.hpp"
#include "tools/assemble/gap/objective.hpp"

namespace hexpipe::assemble::gap {
namespace {

// What a hex that goes counts, in cells that are no hexes: little, because others take its volume. 0.05 and 0.4 give
// the same on six models.
constexpr double price_of_hex_gone = 0.15;
// Larger rooms take long, and hardly any has a better filling.
constexpr std::size_t most_in_room = 100, most_in_room_of_merge = 40;
// How good the cells around become, if they can; a hex counts half (patch.cpp).
constexpr double goal_of_reshaping = 0.3;
constexpr int rounds_of_reshaping = 8;
// No edge becomes shorter than this part of the shortest one of the chosen cells around: the quality of a hex does not
// tell.
constexpr double least_part_of_edge = 0.3;

// Whether the facet, or half of it, is tagged.
bool is_wall(const GapMesh& gap, const Facet& facet) {
  const auto& [a, b, c, d] = facet.corners;
  if (!facet.is_quad()) return gap.is_tagged({a, b, c});
  return gap.is_tagged({a, b, c}) || gap.is_tagged({a, c, d}) || gap.is_tagged({a, b, d}) || gap.is_tagged({b, c, d});
}

// Whether a facet that is no wall lies between the two.
bool are_joined(const GapMesh& gap, const Solid& one, const Solid& two) {
  bool joined = false;
  for_facets(one.kind, one.vertices(), [&](const Facet& facet) {
    if (joined) return;
    const Facet reversed = facet.reversed();
    bool is_common = false;
    for_facets(two.kind, two.vertices(), [&](const Facet& other) { is_common = is_common || other == reversed; });
    joined = is_common && !is_wall(gap, facet);
  });
  return joined;
}

GapCell gap_cell_of(const GapMesh& gap, const Solid& solid, std::int32_t region) {
  std::array<Vertex, 6> corners{};
  std::ranges::copy(solid.vertices(), corners.begin());
  return gap.make(solid.kind, corners, region);
}

// The places of vertices during a lifetime.
class Moved {
 public:
  explicit Moved(GapMesh& gap) : gap_(gap) {}
  Moved(const Moved&) = delete;
  ~Moved() {
    for (auto at = before_.rbegin(); at != before_.rend(); ++at) gap_.move(at->first, at->second);
  }
  void move(Vertex v, const Vec3& to) {
    before_.emplace_back(v, gap_.points()[v]);
    gap_.move(v, to);
  }

 private:
  GapMesh& gap_;
  std::vector<std::pair<Vertex, Vec3>> before_;
};

}  // namespace

bool Piece::has(Vertex v) const {
  return std::ranges::find(solid.vertices(), v) != solid.vertices().end();
}

Piece piece_of(const GapMesh& gap, GapIndex c) {
  const GapCell& cell = gap.cell(c);
  Piece piece{{cell.kind, {}}, cell.region, c};
  std::ranges::copy(cell.vertices(), piece.solid.corners.begin());
  return piece;
}

Piece piece_of(const GapMesh& gap, KeptIndex k) {
  const KeptCell& cell = gap.kept_cell(k);
  return {{cell.kind, cell.corners}, cell.region, no_index, k};
}

std::vector<Piece> pieces_at(const GapMesh& gap, Vertex v) {
  std::vector<Piece> pieces;
  for (const GapIndex c : gap.cells_at(v)) pieces.push_back(piece_of(gap, c));
  for (const KeptIndex k : gap.kept_at(v)) pieces.push_back(piece_of(gap, k));
  return pieces;
}

Vertex Reshaper::mapped(Vertex v) const {
  const auto merge = std::ranges::find(merges_, v, &VertexMerge::from);
  return merge == merges_.end() ? v : merge->into;
}

bool Reshaper::has_both(const Piece& piece) const {
  return std::ranges::any_of(merges_,
                             [&](const VertexMerge& merge) { return piece.has(merge.from) && piece.has(merge.into); });
}

bool Reshaper::is_in_room(const Piece& piece) const {
  return std::ranges::find(room_, piece) != room_.end();
}

// The skin of these cells after the merges: facets lose an edge, or their area. Nothing if a facet would touch itself,
// or be there twice.
std::optional<std::vector<Facet>> Reshaper::mapped_skin(std::span<const Piece> pieces) const {
  std::vector<Facet> skin;
  bool suits = true;
  const auto append = [&](const Facet& facet) {
    std::vector<Vertex> corners;
    for (const Vertex v : facet.vertices())
      if (const Vertex w = mapped(v); corners.empty() || corners.back() != w) corners.push_back(w);
    if (corners.front() == corners.back()) corners.pop_back();
    if (corners.size() < 3) return;
    std::vector<Vertex> distinct = corners;
    sort_unique(distinct);
    const Facet facet_after = Facet::of(corners);
    suits = suits && distinct.size() == corners.size() && std::ranges::find(skin, facet_after) == skin.end();
    add_facet(facet_after, skin);
  };
  for (const Piece& piece : pieces) for_facets(piece.solid.kind, piece.solid.vertices(), append);
  return suits ? std::optional(std::move(skin)) : std::nullopt;
}

// Which of the cells at the vertices that go become others, and the room of the rest. Chosen cells that have only one
// vertex of each pair get the other one (GapMesh::merge_kept()). False if they are of several regions.
bool Reshaper::sort_pieces() {
  std::vector<Piece> pieces;
  for (const VertexMerge& merge : merges_)
    for (const Piece& piece : pieces_at(gap_, merge.from))
      if (std::ranges::find(pieces, piece) == pieces.end()) pieces.push_back(piece);
  for (const Piece& piece : pieces) {
    if (piece.region != pieces.front().region) return false;
    const bool is_rubble = piece.solid.kind == CellKind::tet || piece.solid.kind == CellKind::pyramid;
    if (!has_both(piece)) {
      if (piece.gap != no_index) changed_.push_back({piece, piece.solid});
      continue;
    }
    const auto skin = is_rubble ? std::nullopt : mapped_skin(std::span(&piece, 1));
    const auto solid = skin ? solid_of(*skin) : std::nullopt;
    if (skin && (skin->empty() || solid))
      changed_.push_back({piece, solid});
    else
      room_.push_back(piece);
  }
  return !pieces.empty();
}

// Tets and pyramids that facets join to the room, and to each other. False if that is more than `most` cells.
bool Reshaper::grow_room(std::size_t most) {
  if (room_.size() > most) return false;
  for (std::size_t i = 0; i < room_.size(); ++i) {
    const Piece inside = room_[i];
    for (const Vertex v : inside.solid.vertices())
      for (const GapIndex c : gap_.cells_at(v)) {
        if (gap_.cell(c).kind == CellKind::prism || gap_.cell(c).region != inside.region) continue;
        const Piece piece = piece_of(gap_, c);
        if (is_in_room(piece) || !are_joined(gap_, inside.solid, piece.solid)) continue;
        if (room_.size() == most) return false;
        room_.push_back(piece);
      }
  }
  std::erase_if(changed_, [&](const Changed& changed) { return is_in_room(changed.piece); });
  return true;
}

// Between two cells of the room.
bool Reshaper::has_wall_inside() const {
  std::vector<Facet> skin;
  bool has_wall = false;
  const auto append = [&](const Facet& facet) {
    if (add_facet(facet, skin)) has_wall = has_wall || is_wall(gap_, facet);
  };
  for (const Piece& piece : room_) for_facets(piece.solid.kind, piece.solid.vertices(), append);
  return has_wall;
}

// The vertices inside of the room. Nothing if one of them has to stay.
std::optional<std::vector<Vertex>> Reshaper::free_vertices(std::span<const Facet> skin) const {
  std::vector<Vertex> not_free, inside;
  for (const Facet& facet : skin) not_free.insert(not_free.end(), facet.vertices().begin(), facet.vertices().end());
  for (const VertexMerge& merge : merges_) not_free.insert(not_free.end(), {merge.from, merge.into});
  sort_unique(not_free);
  for (const Piece& piece : room_)
    std::ranges::copy_if(piece.solid.vertices(), std::back_inserter(inside),
                         [&](Vertex v) { return !std::ranges::binary_search(not_free, v); });
  sort_unique(inside);
  const bool are_free = std::ranges::all_of(inside, [&](Vertex v) {
    return gap_.is_inside(v) &&
           std::ranges::all_of(pieces_at(gap_, v), [&](const Piece& piece) { return is_in_room(piece); });
  });
  return are_free ? std::optional(std::move(inside)) : std::nullopt;
}

void Reshaper::take_out(const Piece& piece) {
  if (piece.gap != no_index)
    out_.push_back(piece.gap);
  else
    gone_.push_back(piece.kept);
  around_.insert(around_.end(), piece.solid.vertices().begin(), piece.solid.vertices().end());
}

// What goes, what comes and how the room is filled. False if that is not worth it, whatever the shapes are.
bool Reshaper::plan() {
  out_.clear(), in_.clear(), gone_.clear(), come_.clear(), around_.clear(), middles_.clear();
  filling_ = {};
  for (const Changed& changed : changed_) take_out(changed.piece);
  for (const Piece& piece : room_) take_out(piece);
  sort_unique(around_);
  sort_unique(out_);
  const auto first_prism =
      std::ranges::stable_partition(gone_, [&](KeptIndex k) { return gap_.kept_cell(k).kind == CellKind::hex; });
  hexes_in_gone_ = gone_.size() - first_prism.size();

  const auto skin = mapped_skin(room_);
  if (!skin || has_wall_inside()) return false;
  auto free = free_vertices(*skin);
  if (!free) return false;
  free_ = std::move(*free);
  const auto stay = static_cast<double>(
      std::ranges::count_if(changed_, [](const Changed& changed) { return changed.into.has_value(); }));
  const double now = static_cast<double>(out_.size() + gone_.size() - hexes_in_gone_);
  const double most = now - stay - price_of_hex_gone * static_cast<double>(hexes_in_gone_);
  if (most <= 0) return false;
  Moved moved(gap_);
  for (const VertexMerge& merge : merges_) moved.move(merge.into, merge.at);
  auto filling = fewest_cells(gap_, *skin, static_cast<std::size_t>(std::ceil(most)));
  if (!filling) return false;
  filling_ = std::move(*filling);
  return true;
}

double Reshaper::cost_of_prisms_gone() const {
  double cost = 0;
  for (const KeptIndex k : std::span(gone_).subspan(hexes_in_gone_))
    cost += cost_of(quality_of(CellKind::prism, gap_.points(), gap_.kept_cell(k).vertices()));
  return cost;
}

// The vertices of stars: those that are inside anyhow, then those that were spared, then new ones.
void Reshaper::place_stars() {
  for (const auto& skin : filling_.stars) {
    const Vec3 at = middle_of_star(gap_.points(), skin).at;
    if (middles_.size() < free_.size()) {
      middles_.emplace_back(free_[middles_.size()], at);
      continue;
    }
    if (spare_.empty()) spare_.push_back(gap_.add_vertex(at));
    middles_.emplace_back(spare_.back(), at);
    spare_.pop_back();
  }
}

// Inner vertices of all cells around what changes, those of stars, and those that the merges have placed.
std::vector<Vertex> Reshaper::moving_vertices() const {
  std::vector<Vertex> all, moving;
  for (const Vertex v : around_)
    for (const Piece& piece : pieces_at(gap_, v))
      all.insert(all.end(), piece.solid.vertices().begin(), piece.solid.vertices().end());
  sort_unique(all);
  std::ranges::copy_if(all, std::back_inserter(moving), [&](Vertex v) {
    return gap_.is_inside(v) && mapped(v) == v && !std::ranges::binary_search(free_, v);
  });
  for (const auto& [v, at] : middles_) moving.push_back(v);
  for (const VertexMerge& merge : merges_)
    if (merge.is_fixed) moving.push_back(merge.into);
  sort_unique(moving);
  return moving;
}

// How short an edge may be afterwards.
double Reshaper::least_edge_for(std::span<const Vertex> moving) const {
  const auto shortest_of = [&](CellKind kind, std::span<const Vertex> corners) {
    double shortest = std::numeric_limits<double>::infinity();
    with_topology(kind, [&](auto topology) {
      for (const auto& [a, b] : decltype(topology)::edges)
        shortest = std::min(shortest, norm(gap_.points()[corners[b]] - gap_.points()[corners[a]]));
    });
    return shortest;
  };
  double of_chosen = std::numeric_limits<double>::infinity(), of_those_that_stay = of_chosen;
  for (const Vertex v : around_)
    for (const KeptIndex k : gap_.kept_at(v))
      of_chosen = std::min(of_chosen, shortest_of(gap_.kept_cell(k).kind, gap_.kept_cell(k).vertices()));
  for (const Vertex v : moving)
    for (const GapIndex c : gap_.cells_at(v))
      if (!std::ranges::binary_search(out_, c))
        of_those_that_stay = std::min(of_those_that_stay, shortest_of(gap_.cell(c).kind, gap_.cell(c).vertices()));
  return std::isinf(of_chosen) ? 0 : std::min(least_part_of_edge * of_chosen, of_those_that_stay);
}

bool Reshaper::carry_out() {
  const std::size_t own = free_.size();
  {
    Moved moved(gap_);
    for (const VertexMerge& merge : merges_) moved.move(merge.into, merge.at);
    place_stars();
    for (const auto& [v, at] : middles_) moved.move(v, at);
    const std::int32_t region = (room_.empty() ? changed_.front().piece : room_.front()).region;
    for (const Changed& changed : changed_) {
      if (!changed.into) continue;
      Solid solid = *changed.into;
      for (Vertex& v : solid.corners) v = mapped(v);
      in_.push_back(gap_cell_of(gap_, solid, region));
    }
    for (std::size_t i = 0; i < middles_.size(); ++i)
      for (const Facet& facet : filling_.stars[i]) in_.push_back(cell_on(gap_, facet, middles_[i].first, region));
    for (const Solid& solid : filling_.cells)
      if (solid.kind == CellKind::hex)
        come_.push_back({.corners = solid.corners, .region = region});
      else
        in_.push_back(gap_cell_of(gap_, solid, region));
  }
  const double floor = worth_of(gap_, out_).floor;
  const auto take_back_spare = [&] {
    for (std::size_t i = own; i < middles_.size(); ++i) spare_.push_back(middles_[i].first);
    return false;
  };
  const Replacement replacement{out_, in_, floor, merges_, gone_, come_};
  const std::vector<Vertex> moving = moving_vertices();
  patch_.take(moving, replacement);
  for (const VertexMerge& merge : merges_)
    if (std::ranges::binary_search(moving, merge.into)) patch_.place(merge.into, merge.at);
  for (const auto& [v, at] : middles_) patch_.place(v, at);
  patch_.raise(goal_of_reshaping, rounds_of_reshaping);
  if (patch_.shortest_edge() < least_edge_for(moving)) return take_back_spare();
  const auto fewer = static_cast<std::int64_t>(hexes_in_gone_) - static_cast<std::int64_t>(come_.size());
  const double price = price_of_hex_gone * static_cast<double>(std::max(fewer, std::int64_t{0}));
  const double most = patch_.cost_before() + cost_of_prisms_gone() - price;
  if (!patch_.keeps_floors() || !patch_.costs_at_most(most - least_gain)) return take_back_spare();
  patch_.carry_out(gap_, replacement);
  hexes_gone_ += fewer;
  return true;
}

// Whether the change is made. One that failed is not tried again while its cells are as they were.
bool Reshaper::change() {
  std::vector<GapIndex> cells;
  for (const Changed& changed : changed_)
    if (changed.piece.gap != no_index) cells.push_back(changed.piece.gap);
  for (const Piece& piece : room_)
    if (piece.gap != no_index) cells.push_back(piece.gap);
  std::uint64_t state = TriedRooms::state_of(gap_, cells);
  for (const VertexMerge& merge : merges_)
    state += (std::uint64_t{static_cast<std::uint32_t>(merge.from)} << 32 | static_cast<std::uint32_t>(merge.into)) *
             0xbf58476d1ce4e5b9u;
  if (failed_.contains(state)) return false;
  if (plan() && carry_out()) return true;
  if (!cells.empty()) failed_.insert(state);
  return false;
}

Reshaper::Refilled Reshaper::refill(GapIndex c, std::vector<GapIndex>& room) {
  merges_.clear(), changed_.clear();
  room_.assign(1, piece_of(gap_, c));
  const bool is_small = grow_room(most_in_room);
  room.clear();
  for (const Piece& piece : room_) room.push_back(piece.gap);
  if (!is_small) return Refilled::too_large;
  return change() ? Refilled::yes : Refilled::no;
}

bool Reshaper::merge(std::span<const VertexMerge> merges) {
  merges_.assign(merges.begin(), merges.end());
  changed_.clear(), room_.clear();
  return sort_pieces() && grow_room(most_in_room_of_merge) && change();
}

}  // namespace hexpipe::assemble::gap
