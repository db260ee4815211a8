#pragma once
// A first solution: greedy, then a search, from one or several starts whose results are recombined.

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
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
  // Temperatures in mean weights of a chosen vertex; what suits the graph, where they are not given.
  std::optional<double> hot{}, cold{};
  TabuOptions tabu{};
  int starts = 1;
  std::uint64_t seed = 1;
  std::int64_t iterations = std::numeric_limits<std::int64_t>::max();  // moves or kicks of each start
  // Likewise for each vertex that reductions leave; a search that cools more slowly gains little.
  std::int64_t iterations_a_vertex = std::numeric_limits<std::int64_t>::max();
  bool reduce = true;  // search what exact reductions leave
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
  bool complete = false;        // the solution is optimal: reductions and exact search of small components left nothing
};

// `quality` has an entry for each vertex when the order needs it. The first start is the greedy solution, the others
// are greedy with merits changed at random. Annealing cools from the first to the last of the iterations, or of the
// seconds where these end sooner. Where nothing is left to search it ends at once. `report` is called for improvements.
InitsolResult find_initial_solution(const graph::ConflictGraph& graph, std::span<const double> quality,
                                    const InitsolOptions& options, const Deadline& deadline,
                                    const std::function<void(const InitsolProgress&)>& report = {});

}  // namespace hexpipe::initsol
