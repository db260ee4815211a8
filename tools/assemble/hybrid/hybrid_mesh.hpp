#pragma once
// The mesh under assembly: tets that come and go, and cells in place of some of them; with the tets at each vertex and
// the cells at each quad.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/candidates.hpp"
#include "common/mesh/cell_topology.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "tools/assemble/hybrid/cell_quads.hpp"

namespace hexpipe::assemble::hybrid {

struct HybridCell {
  CellKind kind = CellKind::hex;
  std::array<Vertex, 8> corners{};
  std::int32_t region = 0;
  CandidateIndex candidate = no_index;  // no_index: made here, for conformity or in gap/
  bool alive = true;
  // By quad: the diagonal (0 or 1, see triangles_of) that the cell's interior tets have there, and the boundary tet on
  // it that the cell has absorbed, or no_index.
  std::array<std::uint8_t, 6> inner_diagonal{};
  std::array<TetIndex, 6> sliver{no_index, no_index, no_index, no_index, no_index, no_index};

  int quad_count() const {
    return with_topology(kind, [](auto t) { return static_cast<int>(decltype(t)::quads.size()); });
  }
  // Its normal points outwards.
  Quad quad(int i) const;
  // Of all its quads.
  std::span<const VertexKey<4>> quad_keys(std::array<VertexKey<4>, 6>& keys) const;
  // The diagonal that the mesh has outside the cell, beyond an absorbed tet.
  int outer_diagonal(int i) const { return sliver[i] == no_index ? inner_diagonal[i] : 1 - inner_diagonal[i]; }
};

class HybridMesh {
 public:
  // All tets of `mesh` except those marked in `removed`; no cells yet.
  HybridMesh(const TetMesh& mesh, const std::vector<bool>& removed);
  // With these cells, all of whose quads are in `quads`.
  HybridMesh(const TetMesh& mesh, const std::vector<bool>& removed, IndexedVector<CellIndex, HybridCell> cells,
             CellQuads quads);

  std::vector<Vec3> points;

  Vertex add_point(const Vec3& at);

  std::size_t tet_count() const { return tets_.size(); }  // including removed ones
  const Tet& tet(TetIndex t) const { return tets_[t]; }
  std::int32_t region_of(TetIndex t) const { return regions_[t]; }
  bool is_alive(TetIndex t) const { return alive_[t] != 0; }
  TetIndex add_tet(const Tet& tet, std::int32_t region);
  void remove_tet(TetIndex t);
  void restore_tet(TetIndex t);

  // Calls visit(tet) for the tets at v, in an order that depends only on how the mesh came about.
  template <class Visit>
  void for_tets_at(Vertex v, Visit&& visit) const {
    for (std::int64_t slot = first_[v]; slot >= 0; slot = next_[slot]) visit(TetIndex(slot / 4));
  }
  // The tet that has the triangle, other than `except`; no_index if there is none.
  TetIndex tet_at(const Triangle& triangle, TetIndex except = no_index) const;
  void tets_around_edge(Vertex a, Vertex b, std::vector<TetIndex>& out) const;

  std::size_t cell_count() const { return cells_.size(); }  // including removed ones
  const HybridCell& cell(CellIndex c) const { return cells_[c]; }
  CellIndex add_cell(const HybridCell& cell);
  void remove_cell(CellIndex c);
  void set_sliver(CellIndex c, int quad, TetIndex tet) { cells_[c].sliver[quad] = tet; }
  // The other cell at quad `i` of a cell, or no_index.
  CellIndex partner_at(CellIndex cell, int i) const { return quads_.partner(cell, i); }

 private:
  void link(TetIndex t);
  void unlink(TetIndex t);
  Vertex with_fewest_tets(std::span<const Vertex> vertices) const;

  IndexedVector<TetIndex, Tet> tets_;
  IndexedVector<TetIndex, std::int32_t> regions_;
  IndexedVector<TetIndex, std::uint8_t> alive_;
  // The tets at a vertex are a linked list: slot 4 t + i stands for corner i of tet t.
  std::vector<std::int64_t> first_, next_;
  std::vector<std::int32_t> tet_counts_;  // by vertex

  IndexedVector<CellIndex, HybridCell> cells_;
  CellQuads quads_;
};

}  // namespace hexpipe::assemble::hybrid
