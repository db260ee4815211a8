#pragma once
// The command line of initsol as values.

#include <cstdint>
#include <limits>
#include <optional>

#include "tools/initsol/greedy.hpp"
#include "tools/initsol/tabu_search.hpp"

namespace hexpipe::initsol {

enum class Method {
  anneal,   // simulated annealing over local optima; the slower it cools, the better the result
  tabu,     // the dissertation's search
  descend,  // Push and (1,2)-swaps while they gain
};

struct InitsolOptions {
  GreedyOrder order = GreedyOrder::weight_degree;
  Method method = Method::anneal;
  // Temperatures in mean weights of a chosen vertex; if not given, those that suit the graph.
  std::optional<double> hot{}, cold{};
  TabuOptions tabu{};
  int starts = 1;
  std::uint64_t seed = 1;
  std::int64_t iterations = std::numeric_limits<std::int64_t>::max();  // moves or kicks of each start
  // The same for each vertex that reductions leave. A search that cools more slowly gains little.
  std::int64_t iterations_a_vertex = std::numeric_limits<std::int64_t>::max();
  // Whether annealing of a graph of some size cools slowly only where quick trials show that it gains something.
  bool tries_first = false;
  std::int32_t quads = 0;  // the last vertices of the graph are quads (quad_vertices.hpp), which greedy takes last
  bool reduce = true;      // search what exact reductions leave
};

}  // namespace hexpipe::initsol
