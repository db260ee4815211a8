#pragma once
// The exact algorithms by name, behind one interface.

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/bounds/relaxation.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::exact {

// The first four are those of Verhetsel 2017, 3.2, as they stand there: on bits, without reductions.
enum class ExactAlgorithm {
  complete_search,
  clique_partition,
  clique_cover,  // weighted, with weight splitting
  clique_lp,     // by subgradient
  branch_and_reduce,
  branch_and_cut,
};

// Those that this build has: branch and cut needs CLP.
const std::map<std::string, ExactAlgorithm>& exact_algorithms();
// The name of the best of them.
std::string default_exact_algorithm();

// By which branch and reduce, or branch and cut, bounds what it has reduced.
bounds::Relax relaxation_of(ExactAlgorithm algorithm);

struct ExactResult {
  std::optional<graph::IndependentSet> better;  // the heaviest set found that is heavier than what was asked for
  bool complete = false;                        // it, or that there is none, is proven
  std::int64_t bound = 0;                       // on every set: where it is complete, the optimum or `weight`
  std::int64_t nodes = 0;
};

// Throws DataError where a graph has too many vertices for a search on bits, or weights too large for clique_lp.
void expect_room_for(ExactAlgorithm algorithm, const graph::ConflictGraph& graph);

// Looks for the heaviest set among those heavier than `weight`, until it is proven or the deadline passes. Throws as
// expect_room_for does.
ExactResult solve_exactly(const graph::ConflictGraph& graph, std::int64_t weight, ExactAlgorithm algorithm,
                          const Deadline& deadline);

}  // namespace hexpipe::mwis::exact
