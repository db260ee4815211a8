#pragma once
// The exact algorithms by name, behind one interface.

#include <cstdint>
#include <map>
#include <string>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/bounds/relaxation.hpp"
#include "common/mwis/exact/branch_and_reduce.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis {

enum class ExactAlgorithm {
  branch_and_reduce,
  branch_and_cut,
  // exact/historical: for comparison
  complete_search,
  clique_partition,
  clique_cover,
  clique_lp,
};

// The algorithms in this build; branch and cut needs CLP.
const std::map<std::string, ExactAlgorithm>& exact_algorithms();
// The name of the best algorithm in this build.
std::string default_exact_algorithm();

// The relaxation that branch and reduce, or branch and cut, uses to bound a reduced graph.
bounds::Relax relaxation_of(ExactAlgorithm algorithm);

// Throws DataError if a graph has too many vertices for a search without reductions, or weights too large for
// clique_lp.
void expect_room_for(ExactAlgorithm algorithm, const graph::ConflictGraph& graph);

// Looks for the heaviest set among those heavier than `weight`, until it is proven or the deadline passes. Throws as
// expect_room_for does.
exact::ExactResult solve_exactly(const graph::ConflictGraph& graph, std::int64_t weight, ExactAlgorithm algorithm,
                                 const Deadline& deadline);

}  // namespace hexpipe::mwis
