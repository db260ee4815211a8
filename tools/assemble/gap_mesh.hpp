#pragma once
// The tets between the chosen cells, and the pyramids and prisms made of such, as one mesh that can be changed; and
// what of it may not.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/assemble/hybrid/hybrid_mesh.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"

namespace hexpipe {

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

class GapMesh {
 public:
  static constexpr std::int32_t none = -1;

  // `is_shared`: as in Seam, empty without one.
  GapMesh(HybridMesh& mesh, const SurfaceTags& tags, std::span<const std::uint8_t> is_shared);

  std::span<const Vec3> points() const { return points_; }
  std::span<Vec3> points() { return points_; }
  std::size_t vertex_count() const { return at_.size(); }
  std::size_t cell_count() const { return cells_.size(); }  // with those that are gone
  const GapCell& cell(std::int32_t c) const { return cells_[c]; }
  bool is_alive(std::int32_t c) const { return alive_[c] != 0; }
  std::span<const std::int32_t> cells_at(Vertex v) const { return at_[v]; }
  // True where only cells of the gap are at v, and v lies on no tagged facet and at no seam.
  bool is_free(Vertex v) const { return !fixed_[v] && !at_[v].empty(); }

  bool is_tagged(const Triangle& triangle) const { return tags_.contains(triangle); }

  GapCell make(CellKind kind, const std::array<Vertex, 6>& corners, std::int32_t region) const;

  // Replaces cells by others that fill the same room.
  void replace(std::span<const std::int32_t> out, std::span<const GapCell> in);

  // Brings the mesh that this was made of to the same state. To be called once.
  void write_to(HybridMesh& mesh) const;

  // Throws std::logic_error where the lists of cells at vertices are not those of the cells. For tests.
  void check() const;

 private:
  std::int32_t add(const GapCell& cell, std::int32_t source);

  std::span<Vec3> points_;
  const SurfaceTags& tags_;
  std::vector<GapCell> cells_;
  std::vector<std::uint8_t> alive_;
  std::vector<std::int32_t> source_;  // the tet or the cell of the hybrid mesh, or none
  std::vector<std::vector<std::int32_t>> at_;
  std::vector<bool> fixed_;
};

}  // namespace hexpipe
