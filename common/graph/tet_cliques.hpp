#pragma once
// The cliques that the mesh shows: candidates that share an interior tet exclude each other.

#include "common/graph/clique_cover.hpp"
#include "common/mesh/candidates.hpp"

namespace hexpipe::graph {

// One clique for each tet that several candidates have, in the order of the tets. These cliques have a third of the
// edges of a conflict graph. Made maximal, by candidates that conflict with all members at an edge or a facet, they
// have more than half.
CliqueCover cliques_of_tets(const Candidates& candidates);

}  // namespace hexpipe::graph
