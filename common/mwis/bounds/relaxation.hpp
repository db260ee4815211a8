#pragma once
// What a relaxation proves of a graph: bounds on the weight of independent sets, in whole numbers and free of rounding.

#include <cstdint>
#include <functional>
#include <vector>

#include "common/graph/clique_cover.hpp"
#include "common/graph/conflict_graph.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::bounds {

struct Relaxation {
  std::int64_t bound = 0;                   // on every independent set
  std::vector<std::int64_t> with, without;  // by vertex: on those that have it, and on those that do not
  std::vector<double> fractions;            // by vertex: how much of it the relaxed solution chooses, from 0 to 1
};

// Solves a relaxation of a graph; no more effort than it takes to bring the bound down to `target`. `depth` is that of
// the node, 0 before the first branch.
using Relax =
    std::function<Relaxation(const graph::ConflictGraph& graph, std::int64_t target, int depth, const Deadline&)>;

// The bounds that `prices`, one a clique, prove. They need not be optimal, nor free of rounding: they are taken to
// whole multiples of a small fraction of a weight, of which all sums are exact.
Relaxation bounds_of_prices(const graph::ConflictGraph& graph, const graph::CliqueCover& cover,
                            const std::vector<double>& prices);

}  // namespace hexpipe::mwis::bounds
