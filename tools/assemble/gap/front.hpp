#pragma once
// The facets of a small room that still need a cell. They are written in numbers of the room's own vertices, so that
// most questions of the search (refill.hpp) are a look at one bit.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/mesh/cell_topology.hpp"

namespace hexpipe::assemble::gap {

// A vertex of the room, by its place among them.
using Corner = std::uint8_t;
// Rooms with more corners or facets take long, and seldom have a filling without a vertex inside.
inline constexpr std::size_t most_corners = 12;
inline constexpr std::size_t most_facets = 20;

// Four digits of four bits, as in Facet (skin.hpp): counter-clockwise as seen from outside of its cell, the least
// corner first; a triangle ends in 15.
class SmallFacet {
 public:
  SmallFacet() = default;
  static SmallFacet of(Corner a, Corner b, Corner c) {
    if (b < a && b < c) return {b, c, a, end};
    if (c < a && c < b) return {c, a, b, end};
    return {a, b, c, end};
  }
  static SmallFacet of(std::array<Corner, 4> q) {
    std::ranges::rotate(q, std::ranges::min_element(q));
    return {q[0], q[1], q[2], q[3]};
  }

  Corner operator[](std::size_t i) const { return digits_ >> (12 - 4 * i) & 15; }
  bool is_quad() const { return (digits_ & 15) != end; }
  std::size_t size() const { return is_quad() ? 4 : 3; }
  SmallFacet reversed() const {
    const auto& f = *this;
    return is_quad() ? SmallFacet{f[0], f[3], f[2], f[1]} : SmallFacet{f[0], f[2], f[1], end};
  }
  bool has(Corner c) const { return (*this)[0] == c || (*this)[1] == c || (*this)[2] == c || (*this)[3] == c; }
  // The corners of a triangle alone.
  std::size_t number_of_triangle() const { return digits_ >> 4; }
  bool operator==(const SmallFacet&) const = default;

 private:
  static constexpr Corner end = 15;
  SmallFacet(Corner a, Corner b, Corner c, Corner d)
      : digits_(static_cast<std::uint16_t>(a << 12 | b << 8 | c << 4 | d)) {}

  std::uint16_t digits_ = 0;
};

struct SmallCell {
  CellKind kind = CellKind::tet;
  std::array<Corner, 6> corners{};
};

// Calls visit(facet) for each facet of the cell, triangles first.
template <class Visit>
void for_facets(const SmallCell& cell, Visit&& visit) {
  const auto& c = cell.corners;
  with_topology(cell.kind, [&](auto topology) {
    for (const auto& t : decltype(topology)::triangles) visit(SmallFacet::of(c[t[0]], c[t[1]], c[t[2]]));
    for (const auto& q : decltype(topology)::quads) visit(SmallFacet::of({c[q[0]], c[q[1]], c[q[2]], c[q[3]]}));
  });
}

class Front {
 public:
  std::span<const SmallFacet> facets() const { return std::span(facets_).first(size_); }
  bool empty() const { return size_ == 0; }
  bool has_quads() const { return quads_ > 0; }
  // Whether there is room for the facets of one more cell.
  bool has_room() const { return size_ + 5 <= facets_.size(); }
  bool has(SmallFacet facet) const;
  void add(SmallFacet facet);
  // Facets of the cell that are in the front go, the others come, as their cells on the other side see them.
  void put(const SmallCell& cell);

  // No filling has fewer cells, if its pyramids stand on quads of the front, and its prisms on two of them. Cells that
  // are joined by facets form a body, and b cells in one have b - 1 facets or more between them. So where t tets and p
  // other cells (five facets each) fill k bodies within f facets, 4t + 5p >= f + 2(t + p - k). Each of the p takes a
  // quad, so that p is no more than the number of quads q, and t + p >= (f - q) / 2 - k. Facets with an edge that no
  // third one has belong to the same body: that bounds k.
  std::size_t least_cells() const;
  // Whether `cost` and one for each of least_cells() is below `most`. Bodies are counted only where they decide.
  bool may_cost_less(double cost, double most) const;

 private:
  void remove(SmallFacet facet);
  std::size_t most_bodies() const;
  std::size_t least_by_facets() const;
  std::size_t least_in_bodies(std::size_t bodies) const;

  std::array<SmallFacet, 64> facets_{};
  std::size_t size_ = 0, quads_ = 0;
  std::array<std::uint64_t, 64> has_triangle_{};  // a bit for each number_of_triangle()
};

}  // namespace hexpipe::assemble::gap
