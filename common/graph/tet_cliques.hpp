#pragma once
// The cliques that the mesh knows: candidates that share an interior tet exclude each other.

#include "common/graph/clique_cover.hpp"
#include "common/mesh/candidates.hpp"

namespace hexpipe::graph {

// One for each tet that several candidates have, in the order of the tets. They have a third of the edges of a conflict
// graph; made maximal, by candidates that are in conflict with all of them at an edge or a facet, more than half.
CliqueCover cliques_of_tets(const Candidates& candidates);

}  // namespace hexpipe::graph
