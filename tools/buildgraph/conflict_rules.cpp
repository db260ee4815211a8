#include "tools/buildgraph/conflict_rules.hpp"

#include <algorithm>
#include <array>

namespace hexpipe {
namespace {

// The corners that two cells share, as local numbers in each.
struct SharedCorners {
  std::array<int, 8> of_i, of_j;
  int count = 0;
};

SharedCorners shared_corners(std::span<const Vertex> i, std::span<const Vertex> j) {
  SharedCorners shared;
  for (std::size_t a = 0; a < i.size(); ++a)
    for (std::size_t b = 0; b < j.size(); ++b)
      if (i[a] == j[b]) {
        shared.of_i[shared.count] = static_cast<int>(a);
        shared.of_j[shared.count] = static_cast<int>(b);
        ++shared.count;
      }
  return shared;
}

// All are compared, without a branch.
int shared_corner_count(std::span<const Vertex> i, std::span<const Vertex> j) {
  int count = 0;
  for (const Vertex v : i)
    for (const Vertex w : j) count += v == w ? 1 : 0;
  return count;
}

bool share_interior_tet(std::span<const std::int32_t> i, std::span<const std::int32_t> j) {
  std::size_t a = 0, b = 0;
  while (a < i.size() && b < j.size()) {
    if (i[a] == j[b]) return true;
    ++(i[a] < j[b] ? a : b);
  }
  return false;
}

// Where corner c stands in an edge or facet of a cell, or -1.
template <class Corners>
int place_in(const Corners& corners, int c) {
  const auto at = std::find(corners.begin(), corners.end(), c);
  return at == corners.end() ? -1 : static_cast<int>(at - corners.begin());
}

// The edge or facet of a cell that has just these corners; null where there is none.
template <class List>
const typename List::value_type* with_corners(const List& list, const std::array<int, 8>& corners) {
  for (const auto& item : list)
    if (std::all_of(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(item.size()),
                    [&](int c) { return place_in(item, c) >= 0; }))
      return &item;
  return nullptr;
}

bool is_edge(CellKind kind, const std::array<int, 8>& corners) {
  return with_topology(kind, [&]<class T>(T) { return with_corners(T::edges, corners) != nullptr; });
}

bool is_triangle(CellKind kind, const std::array<int, 8>& corners) {
  return with_topology(kind, [&]<class T>(T) { return with_corners(T::triangles, corners) != nullptr; });
}

// The corner of the four that lies opposite the first of them in their quad; -1 where they are no quad.
int opposite_to_first(CellKind kind, const std::array<int, 8>& corners) {
  return with_topology(kind, [&]<class T>(T) {
    const auto* const quad = with_corners(T::quads, corners);
    return quad == nullptr ? -1 : static_cast<int>((*quad)[(place_in(*quad, corners[0]) + 2) % 4]);
  });
}

// A quad's cyclic order is known by who lies opposite whom.
bool are_same_quad(CellKind kind_i, CellKind kind_j, const SharedCorners& shared) {
  const int opposite_i = opposite_to_first(kind_i, shared.of_i), opposite_j = opposite_to_first(kind_j, shared.of_j);
  if (opposite_i < 0 || opposite_j < 0) return false;
  return place_in(shared.of_i, opposite_i) == place_in(shared.of_j, opposite_j);
}

}  // namespace

bool in_conflict(const Candidates& candidates, std::size_t i, std::size_t j) {
  constexpr int most_compatible = 4;
  if (shared_corner_count(candidates.corners_of(i), candidates.corners_of(j)) > most_compatible) return true;
  if (share_interior_tet(candidates.interior_tets_of(i), candidates.interior_tets_of(j))) return true;
  const SharedCorners shared = shared_corners(candidates.corners_of(i), candidates.corners_of(j));
  const CellKind kind_i = candidates.kind[i], kind_j = candidates.kind[j];
  switch (shared.count) {
    case 0:
    case 1:
      return false;
    case 2:
      return !(is_edge(kind_i, shared.of_i) && is_edge(kind_j, shared.of_j));
    case 3:
      return !(is_triangle(kind_i, shared.of_i) && is_triangle(kind_j, shared.of_j));
    case 4:
      return !are_same_quad(kind_i, kind_j, shared);
    default:
      return true;
  }
}

}  // namespace hexpipe
