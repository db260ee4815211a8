#include "common/conflicts/conflicts.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace hexpipe::conflicts {
namespace {

// The corners of a cell, as bits.
using CornerSet = std::uint8_t;

template <class Corners>
constexpr CornerSet set_of(const Corners& corners) {
  unsigned set = 0;
  for (const auto corner : corners) set |= 1u << corner;
  return static_cast<CornerSet>(set);
}

// Tells what a set of corners forms in a cell.
struct CellFaces {
  std::array<bool, 256> edge_or_triangle{};
  std::array<CornerSet, 256> diagonal{};  // a diagonal of the quad that these corners form; empty if they form none
};

template <class Topology>
constexpr CellFaces find_faces() {
  CellFaces faces;
  for (const LocalEdge& e : Topology::edges) faces.edge_or_triangle[set_of(e)] = true;
  for (const LocalTriangle& t : Topology::triangles) faces.edge_or_triangle[set_of(t)] = true;
  for (const LocalQuad& q : Topology::quads) faces.diagonal[set_of(q)] = set_of(std::array{q[0], q[2]});
  return faces;
}
template <class Topology>
constexpr CellFaces faces_of_kind = find_faces<Topology>();

const CellFaces& faces_of(CellKind kind) {
  return with_topology(kind, []<class Topology>(Topology) -> const CellFaces& { return faces_of_kind<Topology>; });
}

// The corners that two cells share, as local numbers in each.
struct SharedCorners {
  std::array<std::uint8_t, 8> of_i, of_j;
  std::size_t count = 0;
  CornerSet set_i = 0, set_j = 0;
};

SharedCorners shared_corners(std::span<const Vertex> i, std::span<const Vertex> j) {
  SharedCorners shared;
  for (std::size_t a = 0; a < i.size(); ++a)
    for (std::size_t b = 0; b < j.size(); ++b)
      if (i[a] == j[b]) {
        shared.of_i[shared.count] = static_cast<std::uint8_t>(a);
        shared.of_j[shared.count] = static_cast<std::uint8_t>(b);
        ++shared.count;
      }
  shared.set_i = set_of(std::span(shared.of_i).first(shared.count));
  shared.set_j = set_of(std::span(shared.of_j).first(shared.count));
  return shared;
}

// Compares all pairs, without a branch.
int shared_corner_count(std::span<const Vertex> i, std::span<const Vertex> j) {
  int count = 0;
  for (const Vertex v : i)
    for (const Vertex w : j) count += v == w ? 1 : 0;
  return count;
}

bool share_interior_tet(std::span<const TetIndex> i, std::span<const TetIndex> j) {
  std::size_t a = 0, b = 0;
  while (a < i.size() && b < j.size()) {
    if (i[a] == j[b]) return true;
    ++(i[a] < j[b] ? a : b);
  }
  return false;
}

// The diagonals of a quad determine its cyclic order, so two quads are the same if the diagonals of one are those of
// the other.
bool are_same_quad(CornerSet diagonal_i, CornerSet diagonal_j, const SharedCorners& shared) {
  if (diagonal_i == 0 || diagonal_j == 0) return false;
  int on_both_or_none = 0;
  for (std::size_t c = 0; c < 4; ++c)
    on_both_or_none += (diagonal_i >> shared.of_i[c] & 1) == (diagonal_j >> shared.of_j[c] & 1) ? 1 : 0;
  return on_both_or_none % 4 == 0;
}

}  // namespace

bool in_conflict(const Candidates& candidates, std::size_t i, std::size_t j) {
  constexpr int most_compatible = 4;
  if (shared_corner_count(candidates.corners_of(i), candidates.corners_of(j)) > most_compatible) return true;
  if (share_interior_tet(candidates.interior_tets_of(i), candidates.interior_tets_of(j))) return true;
  const SharedCorners shared = shared_corners(candidates.corners_of(i), candidates.corners_of(j));
  const CellFaces &faces_i = faces_of(candidates.kind[i]), &faces_j = faces_of(candidates.kind[j]);
  switch (shared.count) {
    case 0:
    case 1:
      return false;
    case 2:
    case 3:
      return !(faces_i.edge_or_triangle[shared.set_i] && faces_j.edge_or_triangle[shared.set_j]);
    case 4:
      return !are_same_quad(faces_i.diagonal[shared.set_i], faces_j.diagonal[shared.set_j], shared);
    default:
      return true;
  }
}

}  // namespace hexpipe::conflicts
