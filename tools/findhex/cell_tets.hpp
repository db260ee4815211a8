#pragma once
// The tets of a candidate: rules 5 to 7 and 9 of docs/definitions.md 1.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/findhex/mesh_tables.hpp"
#include "tools/findhex/tet_star.hpp"

namespace hexpipe {

// Rule 6, by kind: at least this many interior tets, at most this many tets in all.
template <class Topology>
inline constexpr std::size_t least_interior_tets = 0;
template <>
inline constexpr std::size_t least_interior_tets<HexTopology> = 5;
template <>
inline constexpr std::size_t least_interior_tets<PrismTopology> = 3;
template <>
inline constexpr std::size_t least_interior_tets<PyramidTopology> = 2;

template <class Topology>
inline constexpr std::size_t most_tets = 0;
template <>
inline constexpr std::size_t most_tets<HexTopology> = 15;
template <>
inline constexpr std::size_t most_tets<PrismTopology> = 6;
template <>
inline constexpr std::size_t most_tets<PyramidTopology> = 3;

struct CellTetRules {
  bool inner_vertices = true;  // allow them
  std::size_t max_boundary_tets = 6;
  bool flat_corners = false;  // allow them: rule 9
};

// Why a cell with all its facets in the mesh is no candidate, by the rule that it breaks.
enum class TetVerdict {
  accepted,
  no_interior,      // 5: no tets fill the space between its facets
  tet_count,        // 6
  boundary_tets,    // 6: more than the option allows
  crosses_mesh,     // 6, 7: a boundary, a tagged surface, another region or an unusable tet lies within
  half_on_surface,  // 7: the two outer triangles of a quad differ
  inner_vertex,     // the option forbids them
  flat_corner,      // 9
};

// Which way a flood goes is hard to foresee, for a processor too: what follows decides by arithmetic where it can, not
// by branches.

template <class T, std::size_t Most>
class FixedVector {
 public:
  bool is_full() const { return size_ == Most; }
  void push_back(const T& item) { items_[size_++] = item; }
  void push_back_if(bool is_kept, const T& item) {
    items_[size_] = item;
    size_ += is_kept ? 1 : 0;
  }
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  const T& operator[](std::size_t i) const { return items_[i]; }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + size_; }

 private:
  std::array<T, Most + 1> items_;  // room for one that is not kept
  std::size_t size_ = 0;
};

// A few tets, none of them twice.
template <std::size_t Most>
class FewTets {
 public:
  FewTets() { clear(); }
  void clear() {
    tets_.fill(unused);
    size_ = 0;
  }
  bool is_full() const { return size_ == Most; }
  bool contains(std::int32_t tet) const {
    std::int32_t found = 0;
    for (const std::int32_t other : tets_) found |= tet == other ? -1 : 0;
    return found != 0;
  }
  void add(std::int32_t tet) {
    const bool is_new = !contains(tet);
    tets_[size_] = is_new ? tet : unused;
    size_ += is_new ? 1 : 0;
  }
  // Each tet goes to where as many places are before it as there are less ones.
  void sort() {
    const auto unsorted = tets_;
    for (std::size_t i = 0; i < size_; ++i) {
      std::int32_t less = 0;
      for (const std::int32_t other : unsorted) less += other < unsorted[i] ? 1 : 0;
      tets_[less - (tets_.size() - size_)] = unsorted[i];
    }
  }
  std::size_t size() const { return size_; }
  std::int32_t operator[](std::size_t i) const { return tets_[i]; }
  const std::int32_t* begin() const { return tets_.data(); }
  const std::int32_t* end() const { return tets_.data() + size_; }

 private:
  static constexpr std::int32_t unused = std::numeric_limits<std::int32_t>::min();  // less than all, and not `none`

  std::array<std::int32_t, (Most + 4) / 4 * 4> tets_;  // unused behind the last, one at least
  std::size_t size_ = 0;
};

// Finds and judges the tets of one cell after another. Topology: HexTopology, PrismTopology or PyramidTopology.
template <class Topology>
class CellTets {
 public:
  using CellCorners = std::array<Vertex, Topology::corner_count>;

  CellTets(const MeshTables& tables, const CellTetRules& rules) : tables_(tables), rules_(rules), star_(tables) {}

  // Of a cell whose quads are triangulated quads of the mesh and whose triangles are facets.
  TetVerdict find(const CellCorners& corners);

  // Of an accepted cell, both ascending.
  std::span<const std::int32_t> interior() const { return {interior_.begin(), interior_.end()}; }
  std::span<const std::int32_t> boundary() const { return {boundary_.begin(), boundary_.end()}; }

 private:
  static constexpr std::size_t quad_count = Topology::quads.size();
  static constexpr std::size_t facet_count = quad_count + Topology::triangles.size();

  // A facet of an interior tet whose vertices lie on one facet of the cell, so that the flood did not cross it.
  struct WallFacet {
    std::int32_t tet;
    int facet;
    int of_cell;       // the facet of the cell: quads, then triangles
    unsigned corners;  // of the cell, as bits
  };
  struct TetFacet {
    std::int32_t tet;
    int facet;
  };
  using Starts = FewTets<4 * quad_count>;

  Starts starts() const;
  std::array<unsigned, 4> corner_bits(std::int32_t tet) const;
  Vertex apex_beyond(const TetFacet& facet, std::int32_t beyond) const;
  TetVerdict find_from(std::int32_t start);
  TetVerdict flood_from(std::int32_t start);
  TetVerdict leave(std::int32_t tet);
  TetVerdict find_outer_facets();
  TetVerdict judge_quad(std::size_t quad);
  bool has_flat_corner(const LocalQuad& quad, unsigned diagonal, const std::array<TetFacet, 2>& outermost) const;

  const MeshTables& tables_;
  const CellTetRules rules_;
  TetStar star_;
  CellCorners corners_{};
  FewTets<most_tets<Topology>> interior_;
  FewTets<quad_count> boundary_;
  FixedVector<WallFacet, 4 * most_tets<Topology>> walls_;
  std::array<FixedVector<WallFacet, 2>, facet_count> outer_;  // walls with no interior tet beyond, by facet of the cell
  bool has_inner_vertex_ = false;
};

}  // namespace hexpipe
