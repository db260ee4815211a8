#pragma once
// An upper bound by LP-Clique (Verhetsel 2017, 3.2): the linear relaxation with one row per clique. Its dual is solved
// by entropy-smoothed coordinate steps (Haller and Savchynskyy 2024). Two things differ from the dissertation. It uses
// subgradient steps, which need step lengths and are further from the optimum after the same time. And cliques that the
// relaxed solution violates are added here.

#include <cstdint>
#include <functional>
#include <vector>

#include "common/graph/clique_cover.hpp"
#include "common/mwis/bounds/relaxation.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::bounds {

// A price for every clique, whole and not negative. Any prices prove a bound: a solution pays for at most one member of
// a clique, so its weight is at most the sum of all prices plus the weights of vertices beyond the prices of their
// cliques.
struct CliqueDual {
  std::vector<std::int64_t> prices;
  std::int64_t bound = 0;
  std::int64_t passes = 0;
};

// Exact, in integers. If the bound does not fit 64 bits: the largest number of 64 bits, which bounds every graph.
std::int64_t bound_of_prices(const graph::ConflictGraph& graph, const graph::CliqueCover& cover,
                             const std::vector<std::int64_t>& prices);

// The weight of each vertex minus the prices of its cliques. A solution with v weighs at most bound + min(0, reduced
// cost), a solution without v at most bound - max(0, reduced cost). The sum of the prices must fit 64 bits.
std::vector<std::int64_t> reduced_costs(const graph::ConflictGraph& graph, const graph::CliqueCover& cover,
                                        const std::vector<std::int64_t>& prices);

struct CliqueDualOptions {
  // Passes over all cliques and back. With more passes through the same temperatures, the bound becomes better.
  std::int64_t passes = 300;
  // Ends when the bound is down at this weight, which is then optimal.
  std::int64_t target = 0;
};

// Adds cliques to `cover`. Calls `report` for every better bound.
CliqueDual solve_clique_dual(const graph::ConflictGraph& graph, graph::CliqueCover& cover,
                             const CliqueDualOptions& options, const Deadline& deadline,
                             const std::function<void(const CliqueDual&)>& report = {});

// The same as a relaxation for branch and reduce.
Relaxation relax_by_clique_dual(const graph::ConflictGraph& graph, std::int64_t target, int depth,
                                const Deadline& deadline);

}  // namespace hexpipe::mwis::bounds
