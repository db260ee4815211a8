#pragma once
// The command line of initsol as values.

#include <cstdint>
#include <limits>

#include "common/mwis/local_search/annealing.hpp"
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
  mwis::local_search::Cooling cooling{};
  TabuOptions tabu{};
  int starts = 1;
  std::uint64_t seed = 1;
  std::int64_t iterations = std::numeric_limits<std::int64_t>::max();  // moves or kicks of each start
};

}  // namespace hexpipe::initsol
