#pragma once
// Which tets and vertices of a mesh touch, in flat arrays.

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

// Facet i of a tet is opposite its corner i (TetTopology::triangles).
class TetAdjacency {
 public:
  // Throws DataError naming `source` when a facet belongs to more than two tets; the message counts tets and vertices
  // from 1. `numbers` holds the numbers that the source gives the tets, from 0, if they differ from their places here.
  TetAdjacency(const TetMesh& mesh, const char* source, std::span<const TetIndex> numbers = {});

  // The tet beyond a facet, or no_index at the boundary.
  TetIndex tet_beyond(TetIndex tet, int facet) const { return across_[4 * static_cast<std::size_t>(tet) + facet]; }
  // The tets beyond all four facets.
  std::span<const TetIndex, 4> tets_beyond(TetIndex tet) const {
    return std::span<const TetIndex, 4>(&across_[4 * static_cast<std::size_t>(tet)], 4);
  }
  // The tets at a vertex, ascending.
  std::span<const TetIndex> tets_at(Vertex v) const {
    return std::span(tets_at_vertex_).subspan(tet_offsets_[v], tet_offsets_[v + 1] - tet_offsets_[v]);
  }
  // The vertices joined to v by an edge, ascending.
  std::span<const Vertex> neighbours_of(Vertex v) const {
    return std::span(neighbours_).subspan(neighbour_offsets_[v], neighbour_offsets_[v + 1] - neighbour_offsets_[v]);
  }
  // Lists of something for all neighbours of all vertices can begin with those of v here: the sum of the neighbour
  // counts before v.
  std::int64_t first_neighbour_of(Vertex v) const { return neighbour_offsets_[v]; }
  std::size_t neighbour_count() const { return neighbours_.size(); }
  bool has_edge(Vertex a, Vertex b) const;

 private:
  void file_tets(const TetMesh& mesh);
  void find_neighbours(const TetMesh& mesh);

  std::vector<TetIndex> across_;           // 4 per tet
  std::vector<std::int64_t> tet_offsets_;  // vertices + 1
  std::vector<TetIndex> tets_at_vertex_;
  std::vector<std::int64_t> neighbour_offsets_;
  std::vector<Vertex> neighbours_;
};

// Calls visit(triangle) for each facet of only one tet. It points out of this.
template <class Visit>
void for_each_boundary_facet(const TetMesh& mesh, const TetAdjacency& adjacency, Visit&& visit) {
  for (const auto t : indices<TetIndex>(mesh.tets.size()))
    for (int facet = 0; facet < 4; ++facet) {
      if (adjacency.tet_beyond(t, facet) != no_index) continue;
      const auto& [a, b, c] = TetTopology::triangles[facet];
      visit(Triangle{mesh.tets[t][a], mesh.tets[t][b], mesh.tets[t][c]});
    }
}

// Completes mesh.triangles: appends every facet on the boundary or between two regions that no triangle names yet, with
// tag `tag`. It points out of its tet; at an interface, out of the tet with the lower index. Returns the number of
// triangles added.
std::size_t add_missing_boundary_triangles(TetMesh& mesh, const TetAdjacency& adjacency, std::int32_t tag);

}  // namespace hexpipe
