#pragma once
// An edge clique cover: cliques of the conflict graph such that both ends of every edge are together in one of them.

#include <cstdint>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe {
struct Candidates;
}

namespace hexpipe::graph {

struct CliqueCover {
  std::vector<std::int64_t> offsets{0};  // cliques + 1
  std::vector<std::int32_t> members;     // ascending within a clique

  std::int64_t size() const { return static_cast<std::int64_t>(offsets.size()) - 1; }
  std::span<const std::int32_t> clique(std::int64_t c) const {
    return std::span(members).subspan(offsets[c], offsets[c + 1] - offsets[c]);
  }
  // Adds a clique, given in ascending order.
  void add(const std::vector<std::int32_t>& clique) {
    members.insert(members.end(), clique.begin(), clique.end());
    offsets.push_back(static_cast<std::int64_t>(members.size()));
  }
};

// Maximal cliques that cover all edges. They are grown from edges that no clique has yet, and over neighbours that
// bring as many such edges as possible (Verhetsel 2017, 3.2, the greedy edge clique cover). A vertex without neighbours
// is a clique of its own. Known cliques may come `first`: each is grown until it is maximal, unless the cliques before
// it already have all its edges.
CliqueCover greedy_edge_clique_cover(const ConflictGraph& graph, const CliqueCover& first = {});

// Grows each of `cliques` until it is maximal, unless the cliques before it already have all its edges. Those that are
// no cliques of the graph are left out. Most edges may be in none of the results.
CliqueCover maximal_cliques(const ConflictGraph& graph, const CliqueCover& cliques);

// One clique for each tet that several candidates have, in the order of the tets. These cliques have a third of the
// edges of a conflict graph. Made maximal, by candidates that conflict with all members at an edge or a facet, they
// have more than half.
CliqueCover cliques_of_tets(const Candidates& candidates);

// Adds cliques that have all edges of the vertices from `first` on, whose neighbours are all below `first`: for a quad
// (conflicts/quad_vertices.hpp), one for each side.
void add_cliques_at_last(const ConflictGraph& graph, std::int32_t first, CliqueCover& cover);

// Throws DataError naming `source` when offsets do not ascend, members are out of range, unsorted or repeated, two
// members of a clique are not joined by an edge, or an edge is in no clique. O(edges + pairs in cliques).
void validate(const CliqueCover& cover, const ConflictGraph& graph, const char* source);

// Adds maximal cliques that the cover misses: cliques whose members together are chosen by more than 1. `fractions`
// says how much of each vertex is chosen, from 0 to 1. Returns the number of cliques added.
std::int64_t add_violated_cliques(const ConflictGraph& graph, const std::vector<double>& fractions, CliqueCover& cover);

}  // namespace hexpipe::graph
