#pragma once
// Which facets exist, as seen from each vertex. The neighbours of a vertex are numbered by their places in its sorted
// list; two of them are linked if the three vertices form a facet. For a vertex with up to 64 neighbours, the links of
// each neighbour are one word of bits, so one operation finds what is linked to two neighbours. The few vertices with
// more neighbours have lists.

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::candidates {

class VertexLinks {
 public:
  // Links the facets of the tets with usable[t]. `adjacency` is that of the mesh, and must outlive this object.
  VertexLinks(const TetMesh& mesh, const TetAdjacency& adjacency, const std::vector<bool>& usable);

  std::span<const Vertex> neighbours_of(Vertex v) const { return adjacency_.neighbours_of(v); }
  // The place of w among the neighbours of v, or no_index.
  int place_of(Vertex w, Vertex v) const {
    const auto neighbours = neighbours_of(v);
    if (!is_narrow(v)) return place_among_many(w, neighbours);
    const std::int64_t begin = slot_offsets_[v], mask = slot_offsets_[v + 1] - begin - 1;
    for (std::int64_t slot = first_slot(w) & mask;; slot = (slot + 1) & mask) {
      const std::uint8_t place = slots_[begin + slot];
      if (place == no_place) return no_index;
      if (neighbours[place] == w) return place;
    }
  }

  // Whether v and its neighbours at places i and j form a facet.
  bool are_linked(Vertex v, int i, int j) const {
    return is_narrow(v) ? (row(v, i) >> j & 1) != 0 : are_linked_among_many(v, i, j);
  }
  bool is_facet(Vertex a, Vertex b, Vertex c) const;

  // Whether some neighbour of v is linked to both i and j.
  bool have_common_link(Vertex v, int i, int j) const {
    if (is_narrow(v)) return (row(v, i) & row(v, j)) != 0;
    bool found = false;
    for_each_linked_to_both(v, i, j, [&](int) { found = true; });
    return found;
  }
  // Whether v has few enough neighbours for its links to be bits.
  bool is_narrow(Vertex v) const { return neighbours_of(v).size() <= most_narrow; }
  // For such a vertex: the neighbours linked to i, as bits by place.
  std::uint64_t links_of(Vertex v, int i) const { return row(v, i); }

  // Whether more than one neighbour of v is linked to i.
  bool link_count_exceeds_one(Vertex v, int i) const {
    return is_narrow(v) ? (row(v, i) & (row(v, i) - 1)) != 0 : wide_row(v, i).size() > 1;
  }

  // Calls visit(place), ascending, for the neighbours of v that are linked to i.
  template <class Visit>
  void for_each_linked(Vertex v, int i, Visit&& visit) const {
    if (is_narrow(v))
      for_each_bit(row(v, i), visit);
    else
      for (const std::int32_t place : wide_row(v, i)) visit(place);
  }

  // Calls visit(place), ascending, for the neighbours of v that are linked to both i and j.
  template <class Visit>
  void for_each_linked_to_both(Vertex v, int i, int j, Visit&& visit) const {
    if (is_narrow(v))
      for_each_bit(row(v, i) & row(v, j), visit);
    else
      for (const std::int32_t place : wide_row(v, i))
        if (are_linked(v, j, place)) visit(place);
  }

  // Calls visit(place), ascending, for the neighbours j > i of v that are linked to i, or to some neighbour at place
  // `first` or later that is linked to i.
  template <class Visit>
  void for_each_within_two_links(Vertex v, int i, int first, Visit&& visit) const {
    if (is_narrow(v)) {
      const std::uint64_t linked = row(v, i);
      std::uint64_t reached = linked;
      for_each_bit(linked & ~std::uint64_t{0} << first, [&](int k) { reached |= row(v, k); });
      // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): a narrow row has 64 places
      for_each_bit(i == 63 ? 0 : reached & ~std::uint64_t{0} << (i + 1), visit);
    } else {
      for (const std::int32_t place : wide_within_two_links(v, i, first)) visit(place);
    }
  }

  static constexpr std::size_t most_narrow = 64;

 private:
  static constexpr std::uint8_t no_place = 255;

  template <class Visit>
  static void for_each_bit(std::uint64_t bits, Visit&& visit) {
    for (; bits != 0; bits &= bits - 1) visit(std::countr_zero(bits));
  }

  std::uint64_t row(Vertex v, int i) const { return rows_[adjacency_.first_neighbour_of(v) + i]; }
  static std::int64_t first_slot(Vertex w) { return static_cast<std::uint32_t>(w) * std::uint32_t{0x9e3779b9} >> 16; }
  static int place_among_many(Vertex w, std::span<const Vertex> neighbours);
  bool are_linked_among_many(Vertex v, int i, int j) const;
  std::span<const std::int32_t> wide_row(Vertex v, int i) const;
  std::vector<std::int32_t> wide_within_two_links(Vertex v, int i, int first) const;

  void file_places(Vertex v);
  void link_narrow(const TetMesh& mesh, const std::vector<bool>& usable, Vertex v);
  void link_wide(const TetMesh& mesh, const std::vector<bool>& usable, Vertex v);

  const TetAdjacency& adjacency_;
  // For vertices with bits: a hash table of the places of their neighbours, at least twice as long as their number.
  std::vector<std::int64_t> slot_offsets_;  // vertices + 1
  std::vector<std::uint8_t> slots_;
  // By vertex and place of a neighbour: the links as bits; for vertices with more neighbours, the number of the row in
  // wide_.
  std::vector<std::uint64_t> rows_;
  std::vector<std::int64_t> wide_offsets_{0};
  std::vector<std::int32_t> wide_places_;  // ascending in a row
};

}  // namespace hexpipe::candidates
