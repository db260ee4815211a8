#pragma once
// Two independent sets put together into the heaviest one among their vertices. What only one of them holds is a
// bipartite graph, so a minimum cut finds its best set exactly (optimal recombination: Aggarwal, Orlin, Tai 1997; for
// conflict graphs: Haller and Savchynskyy 2024).

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::mwis::local_search {

// Not lighter than either; that of `b` where both weigh the same. It need not be maximal.
graph::IndependentSet recombine(const graph::ConflictGraph& graph, const graph::IndependentSet& a,
                                const graph::IndependentSet& b);

}  // namespace hexpipe::mwis::local_search
