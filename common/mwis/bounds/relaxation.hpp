#pragma once
// The bounds on the weight of independent sets that a relaxation proves, in whole numbers and free of rounding.

#include <cstdint>
#include <functional>
#include <vector>

#include "common/graph/clique_cover.hpp"
#include "common/graph/conflict_graph.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::bounds {

struct Relaxation {
  std::int64_t bound = 0;                   // on every independent set
  std::vector<std::int64_t> with, without;  // by vertex: on the sets that have it, and on those that do not
  std::vector<double> fractions;            // by vertex: how much of it the relaxed solution chooses, from 0 to 1
};

// Solves a relaxation of a graph; stops when the bound is down to `target`. `depth` is that of the node, 0 before the
// first branch.
using Relax =
    std::function<Relaxation(const graph::ConflictGraph& graph, std::int64_t target, int depth, const Deadline&)>;

// The bounds that `prices`, one per clique, prove. The prices need not be optimal or exact: they are rounded to whole
// multiples of a small fraction of a weight, and all sums of these are exact.
Relaxation bounds_of_prices(const graph::ConflictGraph& graph, const graph::CliqueCover& cover,
                            const std::vector<double>& prices);

}  // namespace hexpipe::mwis::bounds
