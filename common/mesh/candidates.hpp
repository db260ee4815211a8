#pragma once
// The cells that could be built by merging tets: findhex finds them, buildgraph compares them, assemble builds some.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/cell_topology.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

// In Candidates, and as a vertex of their conflict graph.
using CandidateIndex = Index<struct CandidateKind>;

struct Candidates {
  std::vector<std::array<Vertex, 8>> vertices;  // in the numbering of cell_topology.hpp, padded with no_index
  std::vector<CellKind> kind;
  std::vector<double> quality;  // the least scaled Jacobian, over the corners or over the whole element
  std::vector<double> volume;
  std::vector<std::int64_t> tet_offsets{0};  // k+1: interior tets of candidate i are tets[offsets[i]..offsets[i+1])
  std::vector<TetIndex> tets;                // ascending within a candidate
  std::vector<std::int64_t> boundary_tet_offsets{0};
  std::vector<TetIndex> boundary_tets;

  std::size_t size() const { return kind.size(); }
  std::span<const TetIndex> interior_tets_of(std::size_t i) const {
    return std::span(tets).subspan(tet_offsets[i], tet_offsets[i + 1] - tet_offsets[i]);
  }
  std::span<const TetIndex> boundary_tets_of(std::size_t i) const {
    return std::span(boundary_tets)
        .subspan(boundary_tet_offsets[i], boundary_tet_offsets[i + 1] - boundary_tet_offsets[i]);
  }
  std::span<const Vertex> corners_of(std::size_t i) const {
    return std::span(vertices[i]).first(corner_count(kind[i]));
  }
  bool operator==(const Candidates&) const = default;
};

// Appends candidates. If `to` will go on growing, `share_of_all` says how much of the final list will then be there;
// the memory for the rest is reserved at once, so that the list need not move again and again.
void append(Candidates& to, const Candidates& from, double share_of_all = 1);

// Appends candidate i of `from` with its vertices and tets renumbered. Tets whose new number is no_index are left out.
template <class Point, class InteriorTet, class BoundaryTet>
void append_candidate(Candidates& to, const Candidates& from, std::size_t i, Point&& point, InteriorTet&& interior_tet,
                      BoundaryTet&& boundary_tet) {
  std::array<Vertex, 8>& row = to.vertices.emplace_back(from.vertices[i]);
  for (Vertex& v : row)
    if (v != no_index) v = point(v);
  to.kind.push_back(from.kind[i]);
  to.quality.push_back(from.quality[i]);
  to.volume.push_back(from.volume[i]);
  for (const TetIndex t : from.interior_tets_of(i))
    if (const TetIndex number = interior_tet(t); number != no_index) to.tets.push_back(number);
  to.tet_offsets.push_back(static_cast<std::int64_t>(to.tets.size()));
  for (const TetIndex t : from.boundary_tets_of(i))
    if (const TetIndex number = boundary_tet(t); number != no_index) to.boundary_tets.push_back(number);
  to.boundary_tet_offsets.push_back(static_cast<std::int64_t>(to.boundary_tets.size()));
}

// The candidates named by `kept`, in its order.
Candidates select(const Candidates& candidates, std::span<const CandidateIndex> kept);

// Throws DataError naming `source` when arrays disagree in length, a kind is unknown, the padding is wrong, offsets do
// not ascend, or a number is not finite.
void validate(const Candidates& candidates, const char* source);

// Throws DataError naming `source` when a candidate names a vertex or a tet that `mesh` does not have.
void validate_against(const Candidates& candidates, const TetMesh& mesh, const char* source);

}  // namespace hexpipe
