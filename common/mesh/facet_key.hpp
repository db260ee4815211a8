#pragma once
// Edges and facets as keys of hash maps: their vertices in ascending order.

#include <tsl/robin_map.h>
#include <tsl/robin_set.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe {

template <std::size_t N>
using VertexKey = std::array<Vertex, N>;

// Those of edges and facets by a sorting network: it has no branches that a processor could guess wrong.
template <std::size_t N>
VertexKey<N> key_of(std::array<Vertex, N> v) {
  const auto order = [&](std::size_t i, std::size_t k) {
    const Vertex low = std::min(v[i], v[k]), high = std::max(v[i], v[k]);
    v[i] = low, v[k] = high;
  };
  if constexpr (N == 2)
    order(0, 1);
  else if constexpr (N == 3)
    order(0, 1), order(1, 2), order(0, 1);
  else if constexpr (N == 4)
    order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
  else
    std::ranges::sort(v);
  return v;
}
inline VertexKey<2> edge_key(Vertex a, Vertex b) {
  return {std::min(a, b), std::max(a, b)};
}

template <std::size_t N>
struct VertexKeyHash {
  std::size_t operator()(const VertexKey<N>& key) const {
    std::uint64_t h = 0;
    for (Vertex v : key) {
      // Multiply and fold, as in splitmix64, because consecutive vertex numbers must not share their low bits.
      h = (h ^ static_cast<std::uint32_t>(v)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }
};

// The == of std::array calls memcmp, which takes longer than the rest of a look-up.
template <std::size_t N>
struct SameVertexKey {
  bool operator()(const VertexKey<N>& a, const VertexKey<N>& b) const {
    bool same = true;
    for (std::size_t i = 0; i < N; ++i) same &= a[i] == b[i];
    return same;
  }
};

template <std::size_t N, class T>
using KeyMap = tsl::robin_map<VertexKey<N>, T, VertexKeyHash<N>, SameVertexKey<N>>;
template <std::size_t N>
using KeySet = tsl::robin_set<VertexKey<N>, VertexKeyHash<N>, SameVertexKey<N>>;

inline KeySet<2> ridges_of(const TetMesh& mesh) {
  KeySet<2> keys;
  if (mesh.ridges)
    for (const auto& [a, b] : *mesh.ridges) keys.insert(edge_key(a, b));
  return keys;
}

// The two triangles into which a diagonal cuts a quad; they keep its orientation. Diagonal 0 joins corners 0 and 2,
// diagonal 1 joins corners 1 and 3.
inline std::array<Triangle, 2> triangles_of(const Quad& q, int diagonal) {
  if (diagonal == 0) return {{{q[0], q[1], q[2]}, {q[0], q[2], q[3]}}};
  return {{{q[1], q[2], q[3]}, {q[1], q[3], q[0]}}};
}

// Whether two triangles of a quad are among these, whichever diagonal cuts it: then it lies on the surface that they
// are of. The quad's corners may come in any order.
inline bool is_on(const KeySet<3>& triangles, const Quad& quad) {
  int found = 0;
  for (int diagonal = 0; diagonal < 2; ++diagonal)
    for (const Triangle& triangle : triangles_of(quad, diagonal)) found += triangles.contains(key_of(triangle)) ? 1 : 0;
  return found >= 2;
}

// Whether two quads with the same four vertices have the same diagonals.
inline bool same_diagonals(const Quad& a, const Quad& b) {
  return edge_key(a[0], a[2]) == edge_key(b[0], b[2]) || edge_key(a[0], a[2]) == edge_key(b[1], b[3]);
}

}  // namespace hexpipe
