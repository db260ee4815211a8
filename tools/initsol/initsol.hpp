#pragma once
// A first solution: a greedy one, then a search from it, from one start or from several, whose results are recombined.

#include <cstdint>
#include <functional>
#include <span>

#include "common/graph/conflict_graph.hpp"
#include "common/run/deadline.hpp"
#include "tools/initsol/options.hpp"

namespace hexpipe::initsol {

struct InitsolProgress {
  std::int64_t iteration;
  std::int64_t weight;
  std::int64_t greedy_weight = 0;
};

struct InitsolResult {
  graph::IndependentSet solution;
  std::int64_t weight = 0;
  std::int64_t greedy_weight = 0;
  std::int64_t iterations = 0;  // moves or kicks of all starts
  bool complete = false;        // the solution is optimal: reductions and exact search of small components left nothing
};

// `quality` has an entry for each vertex when the order needs it. The first start is the greedy solution, the others
// are greedy with merits changed at random. Annealing cools from the first iteration to the last, or over the seconds
// where these end sooner. Where nothing is left to search it ends at once. `report` is called for improvements.
InitsolResult find_initial_solution(const graph::ConflictGraph& graph, std::span<const double> quality,
                                    const InitsolOptions& options, const Deadline& deadline,
                                    const std::function<void(const InitsolProgress&)>& report = {});

}  // namespace hexpipe::initsol
