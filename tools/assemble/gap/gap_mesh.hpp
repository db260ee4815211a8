#pragma once
// The cells between the chosen cells (tets, and pyramids and prisms made of tets) as one mesh that can be changed. It
// knows which of its vertices and facets have to stay.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <ranges>
#include <span>
#include <vector>

#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::gap {

// In a GapMesh: a cell of the gap, and a chosen cell.
using GapIndex = Index<struct GapKind>;
using KeptIndex = Index<struct KeptKind>;

struct GapCell {
  CellKind kind = CellKind::tet;
  std::array<Vertex, 6> corners{};
  std::int32_t region = 0;
  double quality = 0;  // objective.hpp

  std::span<const Vertex> vertices() const {
    return std::span(corners).first(static_cast<std::size_t>(corner_count(kind)));
  }
  bool has(Vertex v) const;
  int count_common(const GapCell& other) const;  // vertices that both have; three or more are a facet
};

// A cell that was chosen: it stays, though vertices of it may move; only open_hexes() and reshape.hpp take some away.
struct KeptCell {
  CellKind kind = CellKind::hex;
  std::array<Vertex, 8> corners{};
  CellIndex source = no_index;  // its cell in the mesh, or no_index for a new one
  std::int32_t region = 0;
  bool is_alive = true;
  bool has_changed = false;  // is new, or has a vertex that it does not have in the mesh

  std::span<const Vertex> vertices() const {
    return std::span(corners).first(static_cast<std::size_t>(corner_count(kind)));
  }
};

// What the faces of a cell cost (face_costs.hpp), and the age of the cell when that was found.
struct FaceCost {
  std::uint64_t age = std::numeric_limits<std::uint64_t>::max();
  double cost = 0;                   // in all
  std::array<double, 5> of_faces{};  // triangles before quads
  double of_span = 0;
};

class GapMesh {
 public:
  // Both have to outlive this; points move in `mesh` at once, cells change there by write_back().
  // `is_shared`: as in Seam, empty without one.
  GapMesh(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, std::span<const std::uint8_t> is_shared);

  std::span<const Vec3> points() const { return mesh_.points; }
  std::size_t vertex_count() const { return at_.size(); }
  std::size_t cell_count() const { return cells_.size(); }  // with those that are gone
  const GapCell& cell(GapIndex c) const { return cells_[c]; }
  bool is_alive(GapIndex c) const { return alive_[c] != 0; }
  std::span<const GapIndex> cells_at(Vertex v) const { return at_[v]; }
  const KeptCell& kept_cell(KeptIndex c) const { return kept_[c]; }
  std::size_t kept_count() const { return kept_.size(); }  // with those that are gone
  // Those at v that are not gone: a view.
  auto kept_at(Vertex v) const {
    return std::views::filter(kept_at_of(v), [this](KeptIndex c) { return kept_[c].is_alive; });
  }
  // The centres by which faces are judged (common/mesh/face_measures.hpp), each computed once while its cell stays as
  // it is. Between move() and replace() only those of cells that do not have the vertex.
  const Vec3& centre_of(GapIndex c) const;
  const Vec3& centre_of_kept(KeptIndex c) const;
  // Kept for cost_of_faces().
  FaceCost& face_cost_of(GapIndex c) const {
    if (face_costs_.size() < cells_.size()) face_costs_.resize(cells_.size());
    return face_costs_[c];
  }
  // If quad `i` of a chosen cell lies on the boundary: the tagged triangles that it consists of, in the cell's
  // orientation. Nothing if another cell has the quad, too.
  std::optional<std::array<Triangle, 2>> boundary_triangles(KeptIndex kept, int i) const;
  bool has_partner(KeptIndex kept, int i) const;
  // True where v may move and go: only cells of the gap are there, no tagged facet and no seam.
  bool is_free(Vertex v) const { return holds_[v] == 0 && !at_[v].empty(); }
  // True where v may move, though chosen cells may use it: on no tagged facet and at no seam.
  bool is_inside(Vertex v) const { return (holds_[v] & (on_tagged | at_seam)) == 0; }
  // The vertices inside of a cell, and those of all cells at its vertices, ascending.
  std::vector<Vertex> inner_vertices_of(GapIndex c) const;
  std::vector<Vertex> inner_vertices_around(GapIndex c) const;
  bool is_of_kept(Vertex v) const { return (holds_[v] & of_kept) != 0; }
  bool is_at_seam(Vertex v) const { return (holds_[v] & at_seam) != 0; }
  // True where v may go along the surface: only cells of the gap are there, and no seam.
  bool is_free_on_surface(Vertex v) const { return holds_[v] == on_tagged && !at_[v].empty(); }
  // Faces count in the objective unless the vertices have not found their places yet.
  void ignore_faces() { counts_faces_ = false; }
  bool counts_faces() const { return counts_faces_; }
  // From now on faces and cells that solvers refuse cost so much that a few more cells are better, and chosen prisms
  // and pyramids count, too.
  void be_strict() {
    is_strict_ = true;
    face_costs_.clear();
  }
  bool is_strict() const { return is_strict_; }
  bool is_tagged(const Triangle& triangle) const { return tags_.contains(triangle); }
  // Rises whenever a cell at v changes, or a vertex of one moves.
  std::uint32_t age_of(Vertex v) const { return age_[v]; }
  // Rises whenever something at the cell changes.
  std::uint64_t age_of_cell(GapIndex c) const {
    std::uint64_t age = 0;
    for (const Vertex v : cells_[c].vertices()) age += age_[v];
    return age;
  }
  // True when the Jacobian of each cell is positive everywhere, without any doubt.
  bool is_valid() const;

  // A new cell. A prism that some readers would turn round (common/mesh/face_view.hpp) has the quality -1.
  GapCell make(CellKind kind, const std::array<Vertex, 6>& corners, std::int32_t region) const;
  GapCell make_tet(const Tet& corners, std::int32_t region) const;

  // Replaces cells by others that fill the same room.
  void replace(std::span<const GapIndex> out, std::span<const GapCell> in);
  // Undoes replace(out, ...), whose new cells are those from `first_new` on. No other cell may have come since.
  void undo_replace(std::span<const GapIndex> out, GapIndex first_new);
  // Takes a chosen cell away, or puts it back. The caller fills its room.
  void set_alive(KeptIndex kept, bool is_alive);
  // The chosen cells at `from` get the vertex `into` in its place; none that is alive has both. boundary_triangles()
  // and has_partner() know of it after write_back().
  void merge_kept(Vertex from, Vertex into);
  // A hex of vertices that were there from the beginning, which counts as chosen from now on. boundary_triangles() and
  // has_partner() know it after write_back().
  void add_kept(const KeptCell& cell);
  Vertex add_vertex(const Vec3& at);
  // The caller has to replace() all cells at v afterwards.
  void move(Vertex v, const Vec3& to) { mesh_.points[v] = to; }

  // Moves a vertex, and measures the quality of the cells at it again.
  void relocate(Vertex v, const Vec3& to);

  void write_back();

 private:
  // The reasons for which a vertex stays, as bits.
  static constexpr std::uint8_t of_kept = 1, on_tagged = 2, at_seam = 4;

  void add(const GapCell& cell, std::int32_t source);
  void link(GapIndex c);
  void unlink(GapIndex c);
  void hold_if_kept(Vertex v);
  std::span<const KeptIndex> kept_at_of(Vertex v) const {
    if (static_cast<std::size_t>(v) >= first_new_) return {};
    return kept_at_[v];
  }

  hybrid::HybridMesh& mesh_;
  const hybrid::SurfaceTags& tags_;
  IndexedVector<GapIndex, GapCell> cells_;
  IndexedVector<GapIndex, std::uint8_t> alive_;
  IndexedVector<GapIndex, std::int32_t> source_;  // its tet or cell in `mesh`, or no_index for a new one
  std::vector<std::vector<GapIndex>> at_;
  std::vector<std::uint32_t> age_;
  bool counts_faces_ = true, is_strict_ = false;
  std::vector<std::uint8_t> holds_;
  IndexedVector<KeptIndex, KeptCell> kept_;
  std::size_t first_new_ = 0;  // vertices from here on were added: no chosen cell has them
  std::vector<std::vector<KeptIndex>> kept_at_;
  mutable IndexedVector<GapIndex, std::optional<Vec3>> centres_;
  mutable IndexedVector<KeptIndex, std::optional<Vec3>> kept_centres_;
  mutable IndexedVector<GapIndex, FaceCost> face_costs_;
};

// The volume of the chosen hexes.
double hex_volume_of(const GapMesh& gap);

// The edges of the gap's cells between two vertices of chosen cells, the shortest first.
std::vector<std::array<Vertex, 2>> edges_across_gap(const GapMesh& gap);

// Over the cells of the gap at v.
double shortest_edge_at(const GapMesh& gap, Vertex v);

// Whether the Jacobian of a cell is positive everywhere.
bool is_valid(const GapMesh& gap, const GapCell& cell);

}  // namespace hexpipe::assemble::gap
