#pragma once
// Large neighbourhood search (Verhetsel 2017, 3.4 and 4.3): frees a fragment of the graph, solves it while the rest
// stays, and keeps the result if it is not lighter. Three things differ from algorithms 13 to 16. Fragments that do not
// touch each other form a round; they are solved in parallel and applied in order, so the result does not depend on the
// number of threads. Larger fragments are annealed, beside smaller ones that are solved exactly. The search runs on the
// kernel that exact reductions leave.

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mwis/local_search/operator_selection.hpp"
#include "common/run/deadline.hpp"

namespace hexpipe::mwis::local_search {

struct LnsOptions {
  std::uint64_t seed = 1;
  std::int64_t iterations = std::numeric_limits<std::int64_t>::max();  // the number of fragments to solve
  std::size_t fragment_size = 100;                                     // free vertices of the first fragments
  std::size_t largest_fragment = 1000;
  std::int64_t node_limit = 1000;           // of branch and bound, per fragment
  std::size_t annealed_fragment = 2000;     // free vertices of fragments that are annealed; 0: no such fragments
  std::size_t recombined_fragment = 12000;  // the same for fragments that are annealed from an empty set and recombined
  int batch = 16;      // exact fragments per round; a quarter as many are annealed, an eighth recombined
  bool reduce = true;  // search the kernel that exact reductions leave
  // Every thread goes on to the next fragment as soon as it has finished one. Faster, but the result depends on the
  // timing.
  bool free_running = false;
  std::int64_t target = std::numeric_limits<std::int64_t>::max();  // the search ends at this weight
  // The search ends when the last half of its work gained less than this share of the weight. 0: only the other limits
  // hold.
  double worth = 0;
  // By vertex: exact fragments are solved first around these chosen vertices, because solution and bound differ there.
  // Empty: anywhere.
  std::vector<bool> first_places = {};
};

struct LnsProgress {
  std::int64_t iteration;
  std::int64_t weight;
  // The improved vertices, without those that reductions made of several.
  std::span<const std::int32_t> fragment;
  // The whole solution; it takes some time. Valid during the report.
  std::function<graph::IndependentSet()> solution = {};
};

struct LnsResult {
  graph::IndependentSet solution;
  std::int64_t weight = 0;
  std::int64_t iterations = 0;
  std::int64_t improvements = 0;
  // Every connected component was solved completely: there is no heavier solution.
  bool complete = false;
};

// Knowledge for the next search on nearly the same graph: an entry for each vertex that this search chose.
struct LnsMemory {
  struct Place {
    std::int32_t vertex;
    std::array<std::uint32_t, all_operators.size()> tries;  // fragments since something changed around it, by operator
    std::uint32_t size;                                     // of the next fragment to be solved exactly
  };
  std::vector<Place> places;  // ascending
  OperatorScores operator_scores;
};

// `initial` must be independent. `report` is called for every improvement.
LnsResult improve_by_lns(const graph::ConflictGraph& graph, const graph::IndependentSet& initial,
                         const LnsOptions& options, const Deadline& deadline,
                         const std::function<void(const LnsProgress&)>& report = {});

// The same without reductions. It continues from `memory`, and updates it at the end.
LnsResult continue_lns(const graph::ConflictGraph& graph, const graph::IndependentSet& initial,
                       const LnsOptions& options, const Deadline& deadline, LnsMemory& memory,
                       const std::function<void(const LnsProgress&)>& report = {});

}  // namespace hexpipe::mwis::local_search
