// The best cells for a small room, by branch and bound: J. Liu, S. Sun, D. Wang, "Optimal tetrahedralization for small
// polyhedron: a new local transformation strategy for 3-D mesh generation and mesh improvement" (2006), with pyramids
// and prisms, and with the number of cells as what is to be small. Cells are put on facets that still need one until
// none does. No two of them are tested for overlap: they are positive everywhere, and the signed sum of their skins is
// the skin of the room, so that each point of the room lies in exactly one (its winding number is 1).

#include "tools/assemble/refill.hpp"

#include <algorithm>

#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "tools/assemble/objective.hpp"

namespace hexpipe {
namespace {

constexpr std::size_t most_corners = 12;
constexpr std::size_t most_facets = 20;
constexpr int most_steps = 400;

}  // namespace

Refill::Facet Refill::facet_of(std::span<const Local> corners) {
  Facet facet{{none, none, none, none}};
  const auto first = static_cast<std::size_t>(std::ranges::min_element(corners) - corners.begin());
  for (std::size_t i = 0; i < corners.size(); ++i) facet.corners[i] = corners[(first + i) % corners.size()];
  return facet;
}

Refill::Facet Refill::Facet::reversed() const {
  return is_quad() ? Facet{{corners[0], corners[3], corners[2], corners[1]}}
                   : Facet{{corners[0], corners[2], corners[1], none}};
}

template <class Visit>
void Refill::for_facets(const Piece& piece, Visit&& visit) {
  with_topology(piece.kind, [&](auto topology) {
    if constexpr (topology.corner_count <= 6) {
      auto each = [&](const auto& facets) {
        for (const auto& f : facets) {
          std::array<Local, 4> corners{};
          for (std::size_t i = 0; i < f.size(); ++i) corners[i] = piece.corners[f[i]];
          visit(facet_of(std::span(corners).first(f.size())));
        }
      };
      each(decltype(topology)::triangles);
      each(decltype(topology)::quads);
    }
  });
}

Refill::Local Refill::local_of(Vertex v) {
  const auto found = std::ranges::find(vertices_, v);
  if (found != vertices_.end()) return static_cast<Local>(found - vertices_.begin());
  vertices_.push_back(v);
  return static_cast<Local>(vertices_.size() - 1);
}

// What lies between the cells cancels out.
bool Refill::collect_skin(std::span<const std::int32_t> out) {
  vertices_.clear(), front_.clear();
  region_ = gap_.cell(out[0]).region;
  std::vector<Facet> between;
  for (const std::int32_t c : out) {
    const GapCell& cell = gap_.cell(c);
    if (cell.region != region_) return false;
    Piece piece{cell.kind, {}, 0, 0};
    const auto corners = cell.vertices();
    for (std::size_t i = 0; i < corners.size(); ++i) piece.corners[i] = local_of(corners[i]);
    if (vertices_.size() > most_corners + 4) return false;
    for_facets(piece, [&](const Facet& facet) {
      const auto twin = std::ranges::find(front_, facet.reversed());
      if (twin == front_.end()) {
        front_.push_back(facet);
      } else {
        front_.erase(twin);
        between.push_back(facet);
      }
    });
  }
  if (front_.size() > most_facets) return false;
  for (const Facet& facet : between)
    if (!facet.is_quad() &&
        gap_.is_tagged({vertices_[facet.corners[0]], vertices_[facet.corners[1]], vertices_[facet.corners[2]]}))
      return false;
  // Corners of the skin come first; the others go.
  std::vector<Local> number(vertices_.size(), none);
  std::vector<Vertex> kept;
  for (const Facet& facet : front_)
    for (const Local corner : facet.corners)
      if (corner != none && number[corner] == none) {
        number[corner] = static_cast<Local>(kept.size());
        kept.push_back(vertices_[corner]);
      }
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    if (number[i] == none && !gap_.is_free(vertices_[i])) return false;
  for (Facet& facet : front_) {
    std::array<Local, 4> corners{};
    const std::size_t count = facet.is_quad() ? 4 : 3;
    for (std::size_t i = 0; i < count; ++i) corners[i] = number[facet.corners[i]];
    facet = facet_of(std::span(corners).first(count));
  }
  vertices_ = std::move(kept);
  return vertices_.size() <= most_corners;
}

// Fills in what the piece costs, and how large it is; false where it is not good enough.
bool Refill::judge(Piece& piece) {
  std::array<Vertex, 6> corners{};
  const auto count = static_cast<std::size_t>(corner_count(piece.kind));
  for (std::size_t i = 0; i < count; ++i) corners[i] = vertices_[piece.corners[i]];
  const double quality = gap_quality(piece.kind, gap_.points(), std::span(corners).first(count));
  if (quality < floor_) return false;
  piece.cost = cell_cost(quality);
  const auto at = corner_points(gap_.points(), std::span(corners).first(count));
  piece.volume = cell_volume(piece.kind, std::span<const Vec3>(at).first(count));
  return true;
}

// Takes the piece into the list where no facet of it is in the front the wrong way round: another piece is there.
void Refill::offer(Piece piece, std::vector<Piece>& pieces) {
  bool fits = true;
  for_facets(piece, [&](const Facet& facet) {
    if (std::ranges::find(front_, facet) != front_.end())
      ++piece.closes;
    else if (std::ranges::find(front_, facet.reversed()) != front_.end())
      fits = false;
    else
      --piece.closes;
  });
  if (fits && judge(piece)) pieces.push_back(piece);
}

// On two quads of the front that have an edge in common.
void Refill::collect_prisms(const Facet& facet, std::vector<Piece>& pieces) {
  for (const Facet& other : front_) {
    if (!other.is_quad() || other == facet) continue;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 4; ++k) {
        auto one = [&](std::size_t n) { return facet.corners[(i + n) % 4]; };
        auto two = [&](std::size_t n) { return other.corners[(k + n) % 4]; };
        // Quads 0143 and 1254 of the prism.
        if (one(1) == two(0) && one(2) == two(3) && one(0) != two(1) && one(3) != two(2))
          offer({CellKind::prism, {one(0), one(1), two(1), one(3), one(2), two(2)}, 0, 0}, pieces);
      }
  }
}

void Refill::collect_pieces(const Facet& facet, std::vector<Piece>& pieces) {
  pieces.clear();
  const auto& f = facet.corners;
  for (Local apex = 0; apex < vertices_.size(); ++apex) {
    if (std::ranges::find(f, apex) != f.end()) continue;
    if (facet.is_quad())
      offer({CellKind::pyramid, {f[0], f[3], f[2], f[1], apex}, 0, 0}, pieces);
    else
      offer({CellKind::tet, {f[0], f[2], f[1], apex}, 0, 0}, pieces);
  }
  if (facet.is_quad()) collect_prisms(facet, pieces);
}

void Refill::place(const Piece& piece) {
  placed_.push_back(piece);
  for_facets(piece, [&](const Facet& facet) {
    const auto found = std::ranges::find(front_, facet);
    if (found != front_.end())
      front_.erase(found);
    else
      front_.push_back(facet.reversed());
  });
}

// No cell closes more than five facets.
double Refill::least_cost_to_come() const {
  return static_cast<double>((front_.size() + 4) / 5);
}

void Refill::search(double cost, double room) {
  if (front_.empty()) {
    if (cost < most_) most_ = cost, best_ = placed_;
    return;
  }
  if (steps_left_-- <= 0 || cost + least_cost_to_come() >= most_) return;
  // The facet with the fewest choices, quads first: what goes on them closes triangles, too.
  const bool has_quads = std::ranges::any_of(front_, &Facet::is_quad);
  std::vector<Piece> fewest, pieces;
  bool first = true;
  for (const Facet& facet : front_) {
    if (facet.is_quad() != has_quads) continue;
    collect_pieces(facet, pieces);
    std::erase_if(pieces, [&](const Piece& piece) { return piece.volume > room + rounding_; });
    if (pieces.empty()) return;
    if (first || pieces.size() < fewest.size()) fewest.swap(pieces);
    first = false;
    if (fewest.size() == 1) break;
  }
  std::ranges::stable_sort(fewest, [](const Piece& a, const Piece& b) {
    return a.closes != b.closes ? a.closes > b.closes : a.cost < b.cost;
  });
  for (const Piece& piece : fewest) {
    if (cost + piece.cost >= most_) continue;
    const std::vector<Facet> front = front_;
    place(piece);
    search(cost + piece.cost, room - piece.volume);
    placed_.pop_back();
    front_ = front;
  }
}

std::optional<std::vector<GapCell>> Refill::find(std::span<const std::int32_t> out, double floor, double most) {
  if (!collect_skin(out)) return std::nullopt;
  floor_ = floor, most_ = most, steps_left_ = most_steps;
  placed_.clear(), best_.clear();
  double room = 0;
  for (const std::int32_t c : out) {
    const auto corners = gap_.cell(c).vertices();
    const auto at = corner_points(gap_.points(), corners);
    room += cell_volume(gap_.cell(c).kind, std::span<const Vec3>(at).first(corners.size()));
  }
  rounding_ = 1e-9 * room;
  search(0, room);
  if (best_.empty()) return std::nullopt;
  std::vector<GapCell> in;
  for (const Piece& piece : best_) {
    std::array<Vertex, 6> corners{};
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = vertices_[piece.corners[i]];
    in.push_back(gap_.make(piece.kind, corners, region_));
  }
  return in;
}

}  // namespace hexpipe
