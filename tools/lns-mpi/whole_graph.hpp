#pragma once
// A graph that fits the first rank: cut there, its parts sent to the others, and the solution brought back.

#include "common/graph/conflict_graph.hpp"
#include "tools/lns-mpi/piece.hpp"
#include "tools/lns-mpi/ranks.hpp"

namespace hexpipe {

// On the first rank: sends the others their rows and returns its own. The numbers of the vertices are their keys.
OwnedRows scatter_rows(Ranks& ranks, const BlockOwners& owners, const ConflictGraph& graph,
                       const IndependentSet& solution, const std::vector<std::int32_t>& blocks);
// On the others.
OwnedRows receive_rows(Ranks& ranks);

// All ranks call it; the first gets the whole solution, the others nothing.
IndependentSet gather_solution(Ranks& ranks, const Piece& piece);

}  // namespace hexpipe
