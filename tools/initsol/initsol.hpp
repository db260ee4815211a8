#pragma once
// A first solution: greedy, then tabu search, from one or several starts of which the best is kept.

#include <cstdint>
#include <functional>
#include <limits>
#include <span>

#include "common/graph/conflict_graph.hpp"
#include "common/run/deadline.hpp"
#include "tools/initsol/greedy.hpp"
#include "tools/initsol/tabu_search.hpp"

namespace hexpipe {

struct InitsolOptions {
  GreedyOrder order = GreedyOrder::weight_degree;
  TabuOptions tabu{};
  int starts = 1;
  std::uint64_t seed = 1;
  std::int64_t iterations = std::numeric_limits<std::int64_t>::max();  // moves of each start
};

struct InitsolProgress {
  std::int64_t iteration;
  std::int64_t weight;
};

struct InitsolResult {
  IndependentSet solution;
  std::int64_t weight = 0;
  std::int64_t greedy_weight = 0;
  std::int64_t iterations = 0;  // moves of all starts
};

// `quality` has an entry for each vertex when the order needs it. The first start is the greedy solution, the others
// are greedy with merits changed at random. `report` is called for improvements.
InitsolResult find_initial_solution(const ConflictGraph& graph, std::span<const double> quality,
                                    const InitsolOptions& options, const Deadline& deadline,
                                    const std::function<void(const InitsolProgress&)>& report = {});

}  // namespace hexpipe
