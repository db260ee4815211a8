#pragma once
// Combines two independent sets into the heaviest one among their vertices. The vertices that only one of them has form
// a bipartite graph, so a minimum cut finds the best set exactly (optimal recombination: Aggarwal, Orlin, Tai 1997; for
// conflict graphs: Haller and Savchynskyy 2024).

#include "common/graph/conflict_graph.hpp"

namespace hexpipe::mwis::local_search {

// Not lighter than either set; if both weigh the same and nothing better exists, `b`. The result need not be maximal.
graph::IndependentSet recombine(const graph::ConflictGraph& graph, const graph::IndependentSet& a,
                                const graph::IndependentSet& b);

}  // namespace hexpipe::mwis::local_search
