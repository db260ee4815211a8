// The conflicts of docs/definitions.md 2 by sharing. Two cells without a common interior tet, all of whose shared corners are
// joined by edges in both, are never in conflict: their shared corners are one, an edge or a triangle of both, for no
// four corners of a hex, prism or pyramid are all joined, and no three of a hex. Two cells that share an interior tet,
// or two corners that are no edge in one of them, are in conflict unless they meet at a quad of both. So the candidates
// found at a tet or at such a pair are those in conflict, but for some of those at a common quad, which are compared in
// full.

#include "tools/buildgraph/conflicts.hpp"

#include <array>
#include <utility>
#include <vector>

#include "tools/buildgraph/conflict_rules.hpp"

namespace hexpipe {
namespace {

struct CornerPair {
  std::uint8_t a, b;
  bool is_edge;
};

template <class Topology>
constexpr auto make_corner_pairs() {
  constexpr std::size_t n = Topology::corner_count;
  std::array<CornerPair, n*(n - 1) / 2> pairs{};
  std::size_t next = 0;
  for (std::uint8_t a = 0; a < n; ++a)
    for (std::uint8_t b = a + 1; b < n; ++b) {
      bool is_edge = false;
      for (const LocalEdge& e : Topology::edges)
        is_edge = is_edge || (e[0] == a && e[1] == b) || (e[0] == b && e[1] == a);
      pairs[next++] = {a, b, is_edge};
    }
  return pairs;
}
template <class Topology>
constexpr auto corner_pairs = make_corner_pairs<Topology>();

// Pairs are filed under their lower vertex; the key tells edges from others.
std::uint32_t pair_key(Vertex higher, bool is_edge) {
  return static_cast<std::uint32_t>(higher) << 1 | (is_edge ? 0 : 1);
}

// Quads are filed under their lowest vertex. The key is a hash: two quads under one key cost a comparison, no more.
std::uint32_t quad_key(Vertex opposite, Vertex side, Vertex other_side) {
  std::uint64_t hash = static_cast<std::uint64_t>(opposite);
  hash = hash * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(std::min(side, other_side));
  hash = hash * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(std::max(side, other_side));
  return static_cast<std::uint32_t>(hash * 0x9e3779b97f4a7c15u >> 32);
}

// visit(lower vertex, higher vertex, whether they are an edge)
template <class Topology, class Visit>
void for_each_pair(const std::array<Vertex, 8>& corners, Visit&& visit) {
  for (const CornerPair& pair : corner_pairs<Topology>) {
    const auto [low, high] = std::minmax(corners[pair.a], corners[pair.b]);
    visit(low, high, pair.is_edge);
  }
}

// visit(lowest vertex, key)
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
      pairs_(vertex_bound(candidates), candidates.size(),
             [&](std::size_t i, auto&& file) {
               with_topology(candidates.kind[i], [&]<class Topology>(Topology) {
                 for_each_pair<Topology>(candidates.vertices[i], [&](Vertex low, Vertex high, bool is_edge) {
                   file(low, pair_key(high, is_edge));
                 });
               });
             }),
      quads_(vertex_bound(candidates), candidates.size(),
             [&](std::size_t i, auto&& file) {
               with_topology(candidates.kind[i],
                             [&]<class Topology>(Topology) { for_each_quad<Topology>(candidates.vertices[i], file); });
             }),
      tets_(bound_of(candidates.tets), candidates.size(), [&](std::size_t i, auto&& file) {
        for (const std::int32_t tet : candidates.interior_tets_of(i)) file(tet, 0);
      }) {}

void ConflictFinder::collect(std::size_t i, SortedSet& found) const {
  with_topology(candidates_.kind[i], [&]<class Topology>(Topology) { collect_of_kind<Topology>(i, found); });
}

template <class Topology>
void ConflictFinder::collect_of_kind(std::size_t i, SortedSet& found) const {
  auto insert = [&](std::span<const SharingIndex::Entry> entries) {
    for (const auto entry : entries) found.insert(SharingIndex::candidate_of(entry));
  };
  for (const std::int32_t tet : candidates_.interior_tets_of(i)) insert(tets_.with_key(tet, 0));
  for_each_pair<Topology>(candidates_.vertices[i], [&](Vertex low, Vertex high, bool is_edge) {
    insert(pairs_.with_key(low, pair_key(high, false)));
    if (!is_edge) insert(pairs_.with_key(low, pair_key(high, true)));
  });
  for_each_quad<Topology>(candidates_.vertices[i], [&](Vertex low, std::uint32_t key) {
    for (const auto entry : quads_.with_key(low, key)) {
      const std::int32_t j = SharingIndex::candidate_of(entry);
      if (!in_conflict(candidates_, i, static_cast<std::size_t>(j))) found.erase(j);
    }
  });
  found.erase(static_cast<std::int32_t>(i));
}

}  // namespace hexpipe
