#pragma once
// Whether a graph is worth reducing: reductions of a graph of a million hexes take 5 s, and decide 3 % of the vertices;
// copying the rest takes 2 s more. The search of all of it takes 10 s, so large graphs are sampled first.

#include <cstdint>
#include <span>

#include "common/graph/conflict_graph.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::reduce {

// Graphs of up to this many vertices are reduced without a sample, and a search by default visits each vertex often.
inline constexpr std::int32_t most_of_a_small_graph = 65536;

// Whether vertices have so few neighbours on the average that reductions bring more than any search of the same time.
bool is_sparse(std::int64_t vertices, std::int64_t directed_edges);

// Whether it takes a sample to tell.
bool needs_sample(std::int64_t vertices, std::int64_t directed_edges);

struct Sample {
  std::int64_t complete = 0;  // vertices with all their neighbours in the sample
  std::int64_t decided = 0;   // vertices that quick reductions decided
  bool decides_enough() const;
};

// A graph is sampled at this many places; one that is in several blocks, at so many in all or one for each block.
inline constexpr std::int32_t places_of_sample = 8;

// Reduces the surroundings of so many vertices, which are spread over the graph. `incomplete`, by vertex: it has
// neighbours that are not in this graph; empty: none has.
Sample reduce_sample(const graph::ConflictGraph& graph, std::int32_t places, std::span<const char> incomplete,
                     const Deadline& deadline);

}  // namespace hexpipe::mwis::reduce
