#pragma once
// Who touches whom in a tetrahedral mesh, in flat arrays.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

// Facet i of a tet lies opposite its corner i (TetTopology::triangles).
class TetAdjacency {
 public:
  static constexpr std::int32_t none = no_index;

  // Throws DataError naming `source`, and the tets and vertices from 1, when a facet belongs to more than two tets;
  // `numbers`: what these are called there from 0, if not by their places.
  TetAdjacency(const TetMesh& mesh, const char* source, std::span<const std::int32_t> numbers = {});

  // The tet beyond a facet, or none at the boundary.
  std::int32_t tet_beyond(std::int32_t tet, int facet) const {
    const std::int32_t code = across_[4 * static_cast<std::size_t>(tet) + facet];
    return code < 0 ? none : code;
  }
  // All four at once, by facet.
  std::span<const std::int32_t, 4> tets_beyond(std::int32_t tet) const {
    return std::span<const std::int32_t, 4>(&across_[4 * static_cast<std::size_t>(tet)], 4);
  }
  // Ascending.
  std::span<const std::int32_t> tets_at(Vertex v) const {
    return std::span(tets_at_vertex_).subspan(tet_offsets_[v], tet_offsets_[v + 1] - tet_offsets_[v]);
  }
  // The vertices joined to v by an edge, ascending.
  std::span<const Vertex> neighbours_of(Vertex v) const {
    return std::span(neighbours_).subspan(neighbour_offsets_[v], neighbour_offsets_[v + 1] - neighbour_offsets_[v]);
  }
  // Where the neighbours of v begin in a list of those of all vertices, and how long it is.
  std::int64_t first_neighbour_of(Vertex v) const { return neighbour_offsets_[v]; }
  std::size_t neighbour_count() const { return neighbours_.size(); }
  bool has_edge(Vertex a, Vertex b) const;

 private:
  void file_tets(const TetMesh& mesh);
  void find_neighbours(const TetMesh& mesh);

  std::vector<std::int32_t> across_;       // 4 a tet
  std::vector<std::int64_t> tet_offsets_;  // vertices + 1
  std::vector<std::int32_t> tets_at_vertex_;
  std::vector<std::int64_t> neighbour_offsets_;
  std::vector<Vertex> neighbours_;
};

// Completes mesh.triangles: every facet on the boundary or between two regions that no triangle names is appended, with
// tag `tag`, outward from its tet (at an interface: from the tet with the lower index). Returns how many were added.
std::size_t add_missing_boundary_triangles(TetMesh& mesh, const TetAdjacency& adjacency, std::int32_t tag);

}  // namespace hexpipe
