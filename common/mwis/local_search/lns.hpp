#pragma once
// Large neighbourhood search (Verhetsel 2017, 3.4 and 4.3): frees a fragment of the graph, solves it while the rest
// stays, and keeps what is not lighter. Deviates from algorithms 13 to 16 in working in rounds of fragments that do not
// touch each other, solved in parallel and applied in order, so that the result does not depend on the number of
// threads; in annealing larger fragments beside solving smaller ones exactly; and in searching the kernel that exact
// reductions leave.

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/local_search/effort.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::local_search {

struct LnsOptions {
  std::uint64_t seed = 1;
  std::int64_t iterations = std::numeric_limits<std::int64_t>::max();  // fragments solved
  std::size_t fragment_size = 100;                                     // free vertices of the first fragments
  std::size_t largest_fragment = 1000;
  std::int64_t node_limit = 1000;           // of branch and bound, a fragment
  std::size_t annealed_fragment = 2000;     // free vertices of fragments that are annealed; 0: none are
  std::size_t recombined_fragment = 12000;  // likewise of those that are annealed from nothing and recombined
  int batch = 16;      // exact fragments in a round; annealed ones are a quarter of them, recombined an eighth
  bool reduce = true;  // search the kernel that exact reductions leave
  // Every thread goes on to the next fragment when it has done one. Faster, but the result depends on the timing.
  bool free_running = false;
  std::int64_t target = std::numeric_limits<std::int64_t>::max();  // ends the search at this weight
  // Ends it when the last half of its work gained less than this share of the weight; 0: only the other limits do.
  double worth = 0;
  // By vertex: around which chosen ones exact fragments are solved first, because solution and bound differ there.
  // Empty: anywhere.
  std::vector<bool> first_places = {};
};

struct LnsProgress {
  std::int64_t iteration;
  std::int64_t weight;
  // What was improved; without the vertices that reductions made of several.
  std::span<const std::int32_t> fragment;
};

struct LnsResult {
  graph::IndependentSet solution;
  std::int64_t weight = 0;
  std::int64_t iterations = 0;
  std::int64_t improvements = 0;
  // Every connected component was solved to the end: there is no heavier solution.
  bool complete = false;
};

// What a search leaves for the next one on nearly the same graph, of each vertex that it chose.
struct LnsMemory {
  struct Place {
    std::int32_t vertex;
    std::array<std::uint32_t, all_ways.size()> tries;  // fragments since something changed around it, by way
    std::uint32_t size;                                // of the next fragment that is solved exactly
  };
  std::vector<Place> places;  // ascending
  Effort::Accounts effort;
};

// `initial` is independent. `report` is called for every improvement.
LnsResult improve_by_lns(const graph::ConflictGraph& graph, const graph::IndependentSet& initial,
                         const LnsOptions& options, const Deadline& deadline,
                         const std::function<void(const LnsProgress&)>& report = {});

// Likewise without reductions, from what is remembered on, and remembers in the end.
LnsResult continue_lns(const graph::ConflictGraph& graph, const graph::IndependentSet& initial,
                       const LnsOptions& options, const Deadline& deadline, LnsMemory& memory,
                       const std::function<void(const LnsProgress&)>& report = {});

}  // namespace hexpipe::mwis::local_search
