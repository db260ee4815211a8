#pragma once
// The exact algorithms of Verhetsel 2017, 3.2, unchanged: on bits, without reductions. certify uses them only when
// asked to (README.md).

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/exact/branch_and_reduce.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::exact::historical {

// Each looks for the heaviest set among those heavier than `weight`, until it is proven or the deadline passes. The
// graph has to pass expect_room_on_bits; for the linear program also expect_room_for_clique_lp.
ExactResult search_completely(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline);
ExactResult search_by_clique_partition(const graph::ConflictGraph& graph, std::int64_t weight,
                                       const Deadline& deadline);
// Uses a weighted cover with weight splitting.
ExactResult search_by_clique_cover(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline);
// Solves the linear program by subgradient steps.
ExactResult search_by_clique_lp(const graph::ConflictGraph& graph, std::int64_t weight, const Deadline& deadline);

// Throws DataError if the graph has too many vertices for a search on bits.
void expect_room_on_bits(const graph::ConflictGraph& graph);
// Throws DataError if the weights are too large.
void expect_room_for_clique_lp(const graph::ConflictGraph& graph);

}  // namespace hexpipe::mwis::exact::historical
