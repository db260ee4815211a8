#pragma once
// The mesh under assembly: tets that come and go, the cells that replaced some of them, and who lies at a vertex or on
// a quad.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/facet_key.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::assemble::hybrid {

struct HybridCell {
  static constexpr std::int32_t none = -1;

  CellKind kind = CellKind::hex;
  std::array<Vertex, 8> corners{};
  std::int32_t region = 0;
  std::int32_t candidate = none;  // none: a pyramid built for conformity
  bool alive = true;
  // By quad: the diagonal (0 or 1, see triangles_of) that the cell's interior tets have there, and the boundary tet on
  // it that the cell has absorbed.
  std::array<std::uint8_t, 6> inner_diagonal{};
  std::array<std::int32_t, 6> sliver{none, none, none, none, none, none};

  int quad_count() const {
    return with_topology(kind, [](auto t) { return static_cast<int>(decltype(t)::quads.size()); });
  }
  // Outward.
  Quad quad(int i) const;
  // The diagonal that the mesh has on the far side of what the cell replaces.
  int outer_diagonal(int i) const { return sliver[i] == none ? inner_diagonal[i] : 1 - inner_diagonal[i]; }
};

class HybridMesh {
 public:
  static constexpr std::int32_t none = -1;

  // All tets of `mesh` but those marked in `removed`; no cells yet.
  HybridMesh(const TetMesh& mesh, const std::vector<bool>& removed);

  std::vector<Vec3> points;

  Vertex add_point(const Vec3& at);

  std::size_t tet_count() const { return tets_.size(); }  // with those that are gone
  const Tet& tet(std::int32_t t) const { return tets_[t]; }
  std::int32_t region_of(std::int32_t t) const { return regions_[t]; }
  bool is_alive(std::int32_t t) const { return alive_[t] != 0; }
  std::int32_t add_tet(const Tet& tet, std::int32_t region);
  void remove_tet(std::int32_t t);
  void restore_tet(std::int32_t t);

  // visit(tet) for the tets at v, in an order that depends on the history of the mesh alone.
  template <class Visit>
  void for_tets_at(Vertex v, Visit&& visit) const {
    for (std::int64_t slot = first_[v]; slot >= 0; slot = next_[slot]) visit(static_cast<std::int32_t>(slot / 4));
  }
  // The tet that has the triangle, other than `except`; none when there is none.
  std::int32_t tet_at(const Triangle& triangle, std::int32_t except = none) const;
  void tets_around_edge(Vertex a, Vertex b, std::vector<std::int32_t>& out) const;

  std::size_t cell_count() const { return cells_.size(); }  // with those that are gone
  const HybridCell& cell(std::int32_t c) const { return cells_[c]; }
  std::int32_t add_cell(const HybridCell& cell);
  void remove_cell(std::int32_t c);
  void set_sliver(std::int32_t c, int quad, std::int32_t tet) { cells_[c].sliver[quad] = tet; }
  // The other cell at a quad, or none.
  std::int32_t partner_at(const Quad& quad, std::int32_t cell) const;

 private:
  void link(std::int32_t t);
  void unlink(std::int32_t t);

  std::vector<Tet> tets_;
  std::vector<std::int32_t> regions_;
  std::vector<std::uint8_t> alive_;
  // The tets at a vertex are a list: slot 4 t + i stands for corner i of tet t.
  std::vector<std::int64_t> first_, next_;

  std::vector<HybridCell> cells_;
  KeyMap<4, std::array<std::int32_t, 2>> cells_at_quad_;
};

}  // namespace hexpipe::assemble::hybrid
