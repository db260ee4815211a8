#pragma once
// A first solution: greedy, then a search, from one or several starts whose results are recombined.

#include <cstdint>
#include <functional>
#include <limits>
#include <span>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/local_search/annealing.hpp"
#include "common/run/deadline.hpp"
#include "tools/initsol/greedy.hpp"
#include "tools/initsol/tabu_search.hpp"

namespace hexpipe::initsol {

enum class Method {
  anneal,   // simulated annealing over local optima; the slower it cools, the better it gets
  tabu,     // the dissertation's
  descend,  // Push and (1,2)-swaps while they gain
};

struct InitsolOptions {
  GreedyOrder order = GreedyOrder::weight_degree;
  Method method = Method::anneal;
  mwis::local_search::Cooling cooling{};
  TabuOptions tabu{};
  int starts = 1;
  std::uint64_t seed = 1;
  std::int64_t iterations = std::numeric_limits<std::int64_t>::max();  // moves or kicks of each start
};

struct InitsolProgress {
  std::int64_t iteration;
  std::int64_t weight;
};

struct InitsolResult {
  graph::IndependentSet solution;
  std::int64_t weight = 0;
  std::int64_t greedy_weight = 0;
  std::int64_t iterations = 0;  // moves or kicks of all starts
};

// `quality` has an entry for each vertex when the order needs it. The first start is the greedy solution, the others
// are greedy with merits changed at random. Annealing cools from the first to the last of the iterations, or of the
// seconds where these end sooner. `report` is called for improvements.
InitsolResult find_initial_solution(const graph::ConflictGraph& graph, std::span<const double> quality,
                                    const InitsolOptions& options, const Deadline& deadline,
                                    const std::function<void(const InitsolProgress&)>& report = {});

}  // namespace hexpipe::initsol
