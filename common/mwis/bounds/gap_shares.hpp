#pragma once
// Where a solution and the bound of a clique dual differ: the gap, vertex by vertex. By complementary slackness, an
// optimal solution of a tight relaxation has a member of every clique with a price, no vertex of negative reduced cost,
// and all of positive reduced cost. The violations of this add up to the gap.

#include <cstdint>
#include <span>
#include <vector>

#include "common/graph/clique_cover.hpp"
#include "common/graph/conflict_graph.hpp"
#include "common/mwis/bounds/clique_dual.hpp"

namespace hexpipe::mwis::bounds {

// For each vertex of the solution, in its order: its share of the gap, not negative. The share of a vertex that is not
// chosen is divided among its chosen neighbours. The sum is bound - weight, or less if there are no chosen neighbours.
std::vector<std::int64_t> gap_shares(const graph::ConflictGraph& graph, const graph::CliqueCover& cover,
                                     const std::vector<std::int64_t>& prices, const graph::IndependentSet& solution);

// By vertex: whether it belongs to the smallest set of solution vertices that hold most of the gap.
std::vector<bool> holds_most_of_gap(std::int32_t vertex_count, const graph::IndependentSet& solution,
                                    std::span<const std::int64_t> shares);

}  // namespace hexpipe::mwis::bounds
