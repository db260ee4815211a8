#pragma once
// An edge clique cover: cliques of the conflict graph such that the two ends of every edge are together in one of them.

#include <cstdint>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"

namespace hexpipe {

struct CliqueCover {
  std::vector<std::int64_t> offsets{0};  // cliques + 1
  std::vector<std::int32_t> members;     // ascending within a clique

  std::int64_t size() const { return static_cast<std::int64_t>(offsets.size()) - 1; }
  std::span<const std::int32_t> clique(std::int64_t c) const {
    return std::span(members).subspan(offsets[c], offsets[c + 1] - offsets[c]);
  }
  // `clique` ascends.
  void add(const std::vector<std::int32_t>& clique) {
    members.insert(members.end(), clique.begin(), clique.end());
    offsets.push_back(static_cast<std::int64_t>(members.size()));
  }
};

// Maximal cliques, grown from edges that no clique has yet, over neighbours with as many such edges as can be had first
// (Verhetsel 2017, 3.2, the greedy edge clique cover). A vertex without neighbours is a clique of its own.
CliqueCover greedy_edge_clique_cover(const ConflictGraph& graph);

// Adds maximal cliques whose members are chosen by more than 1 together, where `fractions`, one a vertex from 0 to 1,
// says how much of it is: cliques that the cover misses. Returns their number.
std::int64_t add_violated_cliques(const ConflictGraph& graph, const std::vector<double>& fractions, CliqueCover& cover);

}  // namespace hexpipe
