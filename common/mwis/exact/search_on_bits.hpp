#pragma once
// Branch and bound on bits over a whole graph, without reductions. On dense graphs, whose independent sets are small,
// it proves in a second what branch and cut does not in a minute: brock200_2 of the DIMACS cliques takes 0.03 s.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/ground/search_budget.hpp"

namespace hexpipe::mwis::exact {

// The most vertices: a matrix and a row of bits for each depth take some hundred MiB then. No search ends in a lifetime
// on much smaller graphs.
inline constexpr std::int32_t most_on_bits = 4096;

// Whether a search on bits has a prospect: there are few enough vertices, and enough conflicts between them. Very dense
// graphs are proven so or not at all; among the others, the relaxation is often tight.
bool is_dense(const graph::ConflictGraph& graph);
bool is_very_dense(const graph::ConflictGraph& graph);

// The heaviest set among those heavier than `needed`; nothing if none was found. If budget.exhausted() afterwards,
// there may be a heavier one. The graph has at most most_on_bits vertices.
std::optional<graph::IndependentSet> search_on_bits(const graph::ConflictGraph& graph, std::int64_t needed,
                                                    ground::SearchBudget& budget);

// The graph with its vertices in another order, and a set of it as one of the graph, ascending.
graph::ConflictGraph renumbered(const graph::ConflictGraph& graph, const std::vector<std::int32_t>& order);
graph::IndependentSet numbered_back(std::span<const std::uint32_t> set, const std::vector<std::int32_t>& order);

}  // namespace hexpipe::mwis::exact
