#pragma once
// The tets of a candidate: rules 5 to 7 and 9 of docs/definitions.md 1.

#include <algorithm>
#include <array>
#include <cstdint>
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

template <class T, std::size_t Most>
class FixedVector {
 public:
  bool is_full() const { return size_ == Most; }
  void push_back(const T& item) { items_[size_++] = item; }
  void clear() { size_ = 0; }
  bool contains(const T& item) const { return std::find(begin(), end(), item) != end(); }
  std::size_t size() const { return size_; }
  const T& operator[](std::size_t i) const { return items_[i]; }
  T* begin() { return items_.data(); }
  T* end() { return items_.data() + size_; }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + size_; }

 private:
  std::array<T, Most> items_;
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
  using Starts = FixedVector<std::int32_t, 4 * quad_count>;

  Starts starts() const;
  std::array<unsigned, 4> corner_bits(std::int32_t tet) const;
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
  FixedVector<std::int32_t, most_tets<Topology>> interior_;
  FixedVector<std::int32_t, quad_count> boundary_;
  FixedVector<WallFacet, 4 * most_tets<Topology>> walls_;
  std::array<FixedVector<WallFacet, 2>, facet_count> outer_;  // walls with no interior tet beyond, by facet of the cell
  bool has_inner_vertex_ = false;
};

}  // namespace hexpipe
