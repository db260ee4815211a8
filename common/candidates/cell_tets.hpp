#pragma once
// The tets of a candidate: rules 5 to 7, 9 and 10 of docs/definitions.md 1.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "common/candidates/mesh_tables.hpp"
#include "common/candidates/quads.hpp"
#include "common/candidates/tet_star.hpp"
#include "common/mesh/cell_topology.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::candidates {

// Rule 6, by kind: the least number of interior tets, and the greatest number of tets in all.
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
  bool sharp_edges = false;   // allow quads over them: rule 10
};

// Why a cell whose facets all exist in the mesh is no candidate; the number is the rule that it breaks.
enum class TetVerdict {
  accepted,
  no_interior,      // 5: no tets fill the space between its facets
  tet_count,        // 6
  boundary_tets,    // 6: more than the option allows
  crosses_mesh,     // 6, 7: a boundary, a tagged surface, another region or an unusable tet lies within
  half_on_surface,  // 7: the two outer triangles of a quad differ
  inner_vertex,     // the option forbids such cells
  flat_corner,      // 9
  sharp_edge,       // 10
};

// The way of a flood is hard to predict, for a processor too. So the code below decides by arithmetic, not by branches,
// where it can.

// A few tets, sorted at the end.
template <std::size_t Most>
class FewTets {
 public:
  void clear() {
    tets_.fill(unused);
    size_ = 0;
  }
  void push_back(TetIndex tet) { tets_[size_++] = tet; }
  void push_back_if(bool is_kept, TetIndex tet) {
    tets_[size_] = tet;
    size_ += is_kept ? 1 : 0;
  }
  // The place of each tet is the number of lesser ones.
  void sort() {
    tets_[size_] = unused;
    const auto unsorted = tets_;
    for (std::size_t i = 0; i < size_; ++i) {
      int less = 0;
      for (const TetIndex other : unsorted) less += other < unsorted[i] ? 1 : 0;
      tets_[less - (tets_.size() - size_)] = unsorted[i];
    }
  }
  std::size_t size() const { return size_; }
  TetIndex operator[](std::size_t i) const { return tets_[i]; }
  TetIndex* begin() { return tets_.data(); }
  TetIndex* end() { return tets_.data() + size_; }
  const TetIndex* begin() const { return tets_.data(); }
  const TetIndex* end() const { return tets_.data() + size_; }

 private:
  static constexpr TetIndex unused{std::numeric_limits<std::int32_t>::min()};  // less than every tet

  std::array<TetIndex, (Most + 4) / 4 * 4> tets_;  // the tets, one that was not kept, then unused
  std::size_t size_ = 0;
};

// Marks of the current cell on vertices and tets of the mesh, for one thread. All are 0 between cells.
struct CellMarks {
  enum class Interior : std::uint8_t { no, yes };

  explicit CellMarks(const TetMesh& mesh) : corner_bits(mesh.points.size(), 0), interior(mesh.tets.size()) {}

  std::vector<std::uint8_t> corner_bits;  // by vertex: bit c is set if it is corner c
  std::vector<Interior> interior;         // by tet
};

// Finds and judges the tets of one cell after another. Topology is HexTopology, PrismTopology or PyramidTopology.
template <class Topology>
class CellTets {
 public:
  using CellCorners = std::array<Vertex, Topology::corner_count>;

  CellTets(const MeshTables& tables, const CellTetRules& rules, CellMarks& marks)
      : tables_(tables), rules_(rules), marks_(marks), star_(tables) {}

  // The cell's quads must be triangulated quads of the mesh, and its triangles must be facets. `of_first_quad`: the
  // diagonals of its first quad, seen from corner 0.
  TetVerdict find(const CellCorners& corners, Diagonals of_first_quad);

  // The tets of an accepted cell, by their numbers in the mesh, ascending.
  std::span<const TetIndex> interior() const { return {interior_.begin(), interior_.end()}; }
  std::span<const TetIndex> boundary() const { return {boundary_.begin(), boundary_.end()}; }

 private:
  static constexpr std::size_t quad_count = Topology::quads.size();

  // Triangles with three corners of a facet of the cell: four on each quad, one on each triangle.
  static constexpr std::size_t triangle_count = 4 * quad_count + Topology::triangles.size();

  struct TetFacet {
    TetIndex tet;
    std::int32_t facet;
  };
  using Starts = FewTets<4 * quad_count>;

  Starts starts(Diagonals of_first_quad) const;
  Diagonals diagonals_of(const LocalQuad& quad) const;
  std::array<unsigned, 4> corner_bits(const Tet& tet) const;
  Beyond across(TetFacet at) const { return tables_.flood_tet(at.tet).across[at.facet]; }
  Vertex apex_beyond(TetFacet facet, TetIndex beyond) const;
  TetVerdict find_from(TetIndex start);
  TetVerdict judge_from(TetIndex start);
  TetVerdict flood_from(TetIndex start);
  TetVerdict leave(TetIndex tet);
  TetVerdict stop_at(const std::array<Beyond, 4>& next);
  void add_interior(TetIndex tet);
  TetVerdict judge_walls() const;
  TetVerdict judge_quad(std::size_t quad);
  bool is_over_sharp_edge(const LocalQuad& quad, unsigned diagonal) const;
  bool has_flat_corner(const LocalQuad& quad, unsigned diagonal, const std::array<TetFacet, 2>& outermost) const;

  const MeshTables& tables_;
  const CellTetRules rules_;
  CellMarks& marks_;
  TetStar star_;
  CellCorners corners_{};
  FewTets<most_tets<Topology> + 4> interior_;  // a flood notices too many tets only after it has left one
  FewTets<quad_count> boundary_;
  // Facets of interior tets that lie on a facet of the cell, so that the flood did not cross them; by triangle of the
  // cell, with one more entry for facets that lie on none. As bits: triangles with interior tets on one side (outer),
  // and on both (inner).
  std::array<TetFacet, triangle_count + 1> walls_{};
  std::uint32_t outer_ = 0, inner_ = 0;
  bool has_inner_vertex_ = false;
};

}  // namespace hexpipe::candidates
