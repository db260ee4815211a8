#pragma once
// The tets between the chosen cells, and the pyramids and prisms made of such, as one mesh that can be changed; and
// what of it may not.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/vertex_items.hpp"
#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe::assemble::gap {

struct GapCell {
  CellKind kind = CellKind::tet;
  std::array<Vertex, 6> corners{};
  std::int32_t region = 0;
  double quality = 0;  // objective.hpp

  std::span<const Vertex> vertices() const {
    return std::span(corners).first(static_cast<std::size_t>(corner_count(kind)));
  }
  bool has(Vertex v) const;
};

// A cell that was chosen: it stays, though vertices of it may move.
struct KeptCell {
  CellKind kind = CellKind::hex;
  std::array<Vertex, 8> corners{};

  std::span<const Vertex> vertices() const {
    return std::span(corners).first(static_cast<std::size_t>(corner_count(kind)));
  }
};

class GapMesh {
 public:
  // Both have to outlive this; points move in `mesh` at once, cells change there by write_back().
  // `is_shared`: as in Seam, empty without one.
  GapMesh(hybrid::HybridMesh& mesh, const hybrid::SurfaceTags& tags, std::span<const std::uint8_t> is_shared);

  std::span<const Vec3> points() const { return mesh_.points; }
  std::size_t vertex_count() const { return at_.size(); }
  std::size_t cell_count() const { return cells_.size(); }  // with those that are gone
  const GapCell& cell(std::int32_t c) const { return cells_[c]; }
  bool is_alive(std::int32_t c) const { return alive_[c] != 0; }
  std::span<const std::int32_t> cells_at(Vertex v) const { return at_[v]; }
  const KeptCell& kept_cell(std::int32_t c) const { return kept_[c]; }
  std::span<const std::int32_t> kept_at(Vertex v) const { return kept_at_.at(v); }
  // True where v may move and go: only cells of the gap are there, no tagged facet and no seam.
  bool is_free(Vertex v) const { return holds_[v] == 0 && !at_[v].empty(); }
  // True where v may move, though chosen cells may use it: on no tagged facet and at no seam.
  bool is_inside(Vertex v) const { return (holds_[v] & (on_tagged | at_seam)) == 0; }
  // True where v may go along the surface: only cells of the gap are there, and no seam.
  bool is_free_on_surface(Vertex v) const { return holds_[v] == on_tagged && !at_[v].empty(); }
  // Faces count in the objective unless the vertices have not found their places yet.
  void ignore_faces() { counts_faces_ = false; }
  bool counts_faces() const { return counts_faces_; }
  bool is_tagged(const Triangle& triangle) const { return tags_.contains(triangle); }
  // Rises whenever a cell at v changes.
  std::uint32_t age_of(Vertex v) const { return age_[v]; }
  // True when the Jacobian of each cell is positive everywhere, without any doubt.
  bool is_valid() const;

  // A new cell. A prism that some readers would turn round (common/mesh/face_view.hpp) has the quality -1.
  GapCell make(CellKind kind, const std::array<Vertex, 6>& corners, std::int32_t region) const;
  GapCell make_tet(const Tet& corners, std::int32_t region) const;

  // Replaces cells by others that fill the same room.
  void replace(std::span<const std::int32_t> out, std::span<const GapCell> in);
  // To be followed by replace() of all cells at v.
  void move(Vertex v, const Vec3& to) { mesh_.points[v] = to; }

  // Moves a vertex; the cells at it are the same, of another quality.
  void relocate(Vertex v, const Vec3& to);

  void write_back();

 private:
  // What holds a vertex, as bits.
  static constexpr std::uint8_t of_kept = 1, on_tagged = 2, at_seam = 4;

  void add(const GapCell& cell, std::int32_t source);

  hybrid::HybridMesh& mesh_;
  const hybrid::SurfaceTags& tags_;
  std::vector<GapCell> cells_;
  std::vector<std::uint8_t> alive_;
  std::vector<std::int32_t> source_;  // the tet or the cell of `mesh` that it was, or no_index
  std::vector<std::vector<std::int32_t>> at_;
  std::vector<std::uint32_t> age_;
  bool counts_faces_ = true;
  std::vector<std::uint8_t> holds_;
  std::vector<KeptCell> kept_;
  VertexItems kept_at_;
};

// Whether the Jacobian of a cell is positive everywhere.
bool is_valid(const GapMesh& gap, const GapCell& cell);

}  // namespace hexpipe::assemble::gap
