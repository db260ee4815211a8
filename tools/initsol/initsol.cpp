#include "tools/initsol/initsol.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "common/run/parallel.hpp"

namespace hexpipe {
namespace {

// Moves between two looks at which start is ahead; some milliseconds.
constexpr std::int64_t moves_a_round = 1000;

IndependentSet start_solution(const ConflictGraph& graph, std::vector<double> merits, const InitsolOptions& options,
                              int index) {
  if (index > 0) {
    Random random(options.seed, static_cast<std::uint64_t>(index));
    for (double& merit : merits) merit *= random.uniform(0.8, 1.2);
  }
  return greedy(graph, merits);
}

}  // namespace

InitsolResult find_initial_solution(const ConflictGraph& graph, std::span<const double> quality,
                                    const InitsolOptions& options, const Deadline& deadline,
                                    const std::function<void(const InitsolProgress&)>& report) {
  const std::vector<double> vertex_merits = merits(graph, options.order, quality);
  std::vector<std::unique_ptr<TabuSearch>> searches(static_cast<std::size_t>(options.starts));
  parallel_for(options.starts, 1, [&](std::int64_t i) {
    const IndependentSet start = start_solution(graph, vertex_merits, options, static_cast<int>(i));
    // Streams 0, 1, ... of the seed make the starts, the ones after them search.
    searches[i] = std::make_unique<TabuSearch>(graph, start, options.tabu,
                                               Random(options.seed, static_cast<std::uint64_t>(options.starts + i)));
  });

  InitsolResult result;
  result.greedy_weight = searches.front()->best_weight();
  const auto leader = [&] {
    return std::ranges::max_element(searches, {}, [](const auto& search) { return search->best_weight(); })->get();
  };
  for (std::int64_t done = 0; done < options.iterations && !deadline.passed();) {
    const std::int64_t moves = std::min(moves_a_round, options.iterations - done);
    parallel_for(options.starts, 1, [&](std::int64_t i) { searches[i]->run(moves, deadline); });
    done += moves;
    if (report && leader()->best_weight() > result.weight) {
      result.weight = leader()->best_weight();
      report({done, result.weight});
    }
    if (std::ranges::all_of(searches, [&](const auto& search) { return search->moves() < done; })) break;
  }
  for (const auto& search : searches) result.iterations += search->moves();
  result.solution = leader()->best();
  result.weight = leader()->best_weight();
  return result;
}

}  // namespace hexpipe
