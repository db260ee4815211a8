// Finds the conflicts of docs/definitions.md 2 from what candidates share. Take two cells without a common interior tet
// whose shared corners are all joined by edges in both. They are never in conflict: the corners that they share are one
// corner, an edge or a triangle of both, because no four corners of a hex, prism or pyramid are all joined, and no
// three of a hex. Two cells that share an interior tet, or two corners that are no edge in one of them, are in conflict
// unless they meet at a quad of both. So the candidates found at a tet or at such a pair are in conflict, except for
// some at a common quad; those are compared in full.

#include "common/conflicts/conflicts.hpp"

#include <array>
#include <utility>
#include <vector>

namespace hexpipe::conflicts {
namespace {

// Quads are filed under their lowest vertex. The key is a hash: two quads with the same key only cost a comparison.
std::uint32_t quad_key(Vertex opposite, Vertex side, Vertex other_side) {
  std::uint64_t hash = static_cast<std::uint64_t>(opposite);
  hash = hash * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(std::min(side, other_side));
  hash = hash * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(std::max(side, other_side));
  return static_cast<std::uint32_t>(hash * 0x9e3779b97f4a7c15u >> 32);
}

// Calls visit(lowest vertex, key) for each quad.
template <class Topology, class Visit>
void for_each_quad(const std::array<Vertex, 8>& corners, Visit&& visit) {
  for (const LocalQuad& q : Topology::quads) {
    std::size_t low = 0;
    for (std::size_t i = 1; i < 4; ++i)
      if (corners[q[i]] < corners[q[low]]) low = i;
    auto from_low = [&](std::size_t i) { return corners[q[(low + i) % 4]]; };
    visit(from_low(0), quad_key(from_low(2), from_low(1), from_low(3)));
  }
}

template <class Range>
std::size_t bound_of(const Range& numbers) {
  return numbers.empty() ? 0 : static_cast<std::size_t>(*std::max_element(numbers.begin(), numbers.end())) + 1;
}

std::size_t vertex_bound(const Candidates& candidates) {
  if (candidates.vertices.empty()) return 0;
  Vertex highest = 0;
  for (const auto& row : candidates.vertices) highest = std::max(highest, *std::max_element(row.begin(), row.end()));
  return static_cast<std::size_t>(highest) + 1;
}

}  // namespace

ConflictFinder::ConflictFinder(const Candidates& candidates)
    : candidates_(candidates),
      segments_(candidates, vertex_bound(candidates)),
      quads_(vertex_bound(candidates), candidates.size(),
             [&](std::size_t i, auto&& file) {
               with_topology(candidates.kind[i],
                             [&]<class Topology>(Topology) { for_each_quad<Topology>(candidates.vertices[i], file); });
             }),
      tets_(bound_of(candidates.tets), candidates.size(), [&](std::size_t i, auto&& file) {
        for (const TetIndex tet : candidates.interior_tets_of(i)) file(tet, 0);
      }) {}

void ConflictFinder::collect_lower(std::size_t i, SortedSet& found) const {
  with_topology(candidates_.kind[i], [&]<class Topology>(Topology) { collect_lower_of_kind<Topology>(i, found); });
}

template <class Topology>
void ConflictFinder::collect_lower_of_kind(std::size_t i, SortedSet& found) const {
  const CandidateIndex self(i);
  for (const TetIndex tet : candidates_.interior_tets_of(i))
    for (const auto entry : tets_.in_bucket(static_cast<std::size_t>(tet))) {
      const CandidateIndex j = SharingIndex::candidate_of(entry);
      if (j >= self) break;
      found.insert(j);
    }
  const auto insert_lower = [&](std::span<const std::int32_t> ascending) {
    for (const auto j : as_indices<CandidateIndex>(ascending)) {
      if (j >= self) break;
      found.insert(j);
    }
  };
  const auto& corners = candidates_.vertices[i];
  for (std::size_t pair = 0; pair < corner_pairs<Topology>.size(); ++pair) {
    const CornerPair& p = corner_pairs<Topology>[pair];
    const auto segment = segments_.segment_of(i, pair, std::min(corners[p.a], corners[p.b]));
    insert_lower(segment.not_as_edge);
    if (!p.is_edge) insert_lower(segment.as_edge);
  }
  for_each_quad<Topology>(corners, [&](Vertex low, std::uint32_t key) {
    for (const auto entry : quads_.with_key(low, key)) {
      const CandidateIndex j = SharingIndex::candidate_of(entry);
      if (j >= self) break;
      if (!in_conflict(candidates_, i, static_cast<std::size_t>(j))) found.erase(j);
    }
  });
}

}  // namespace hexpipe::conflicts
