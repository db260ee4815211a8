#pragma once
// Which candidates share two vertices, and for which of them the two are an edge. Every pair of corners of a candidate
// knows its place here, so no search is needed afterwards.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/candidates.hpp"

namespace hexpipe::conflicts {

// Two corners of a cell.
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
inline constexpr auto corner_pairs = make_corner_pairs<Topology>();

class SegmentIndex {
 public:
  // The candidates that have both vertices, ascending.
  struct Segment {
    std::span<const std::int32_t> as_edge, not_as_edge;
  };

  SegmentIndex(const Candidates& candidates, std::size_t vertex_count);

  // The segment of two corners of a candidate. `pair` is the place of these corners in corner_pairs of its kind.
  Segment segment_of(std::size_t candidate, std::size_t pair, Vertex lower_vertex) const {
    const std::int32_t* const at = entries_.data() + offsets_[lower_vertex] + places_[stride_ * candidate + pair];
    const auto edges = static_cast<std::size_t>(at[0]), others = static_cast<std::size_t>(at[1]);
    return {{at + 2, edges}, {at + 2 + edges, others}};
  }

 private:
  // The candidates at each vertex, ascending.
  struct Filed {
    std::vector<std::int64_t> offsets;  // vertices + 1
    std::vector<CandidateIndex> candidates;
  };
  static Filed file(const Candidates& candidates, std::size_t vertex_count);
  void make_segments(const Candidates& candidates, std::size_t vertex_count);

  std::size_t stride_;  // the number of pairs of the kind with the most
  std::vector<std::uint32_t>
      places_;  // by candidate and pair: the place of the segment, counted from the lower vertex's first
  std::vector<std::int64_t> offsets_;  // vertices + 1
  std::vector<std::int32_t> entries_;  // for each segment: how many candidates have it as an edge, how many do not,
                                       // then the former, then the latter
};

}  // namespace hexpipe::conflicts
