#include "tools/initsol/initsol.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "common/mwis/local_search/recombination.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::initsol {
namespace {

// Moves between two looks at which start is ahead; some milliseconds.
constexpr std::int64_t most_moves_a_round = 1000;
// Few iterations cool down in as many steps.
constexpr std::int64_t least_rounds = 100;

graph::IndependentSet start_solution(const graph::ConflictGraph& graph, std::vector<double> merits,
                                     const InitsolOptions& options, std::int64_t index) {
  if (index > 0) {
    Random random(options.seed, static_cast<std::uint64_t>(2 * index));
    for (double& merit : merits) merit *= random.uniform(0.8, 1.2);
  }
  return greedy(graph, merits);
}

class Search {
 public:
  virtual ~Search() = default;
  // `progress` from 0 to 1 is what was used of the iterations or of the time.
  virtual void run(std::int64_t moves, double progress, const Deadline& deadline) = 0;
  virtual std::int64_t moves() const = 0;
  virtual std::int64_t best_weight() const = 0;
  virtual graph::IndependentSet best() const = 0;
};

class TabuStart : public Search {
 public:
  TabuStart(const graph::ConflictGraph& graph, const graph::IndependentSet& start, const InitsolOptions& options,
            Random random)
      : search_(graph, start, options.tabu, random) {}
  void run(std::int64_t moves, double, const Deadline& deadline) override { search_.run(moves, deadline); }
  std::int64_t moves() const override { return search_.moves(); }
  std::int64_t best_weight() const override { return search_.best_weight(); }
  graph::IndependentSet best() const override { return search_.best(); }

 private:
  TabuSearch search_;
};

class AnnealedStart : public Search {
 public:
  AnnealedStart(const graph::ConflictGraph& graph, const graph::IndependentSet& start, const InitsolOptions& options,
                Random random, const Deadline& deadline)
      : cooling_(options.cooling), search_(graph, start, random, deadline), unit_(search_.mean_weight()) {}
  void run(std::int64_t moves, double progress, const Deadline& deadline) override {
    search_.run(moves, unit_ * cooling_.at(progress), deadline);
  }
  std::int64_t moves() const override { return search_.kicks(); }
  std::int64_t best_weight() const override { return search_.best_weight(); }
  graph::IndependentSet best() const override { return search_.best(); }

 private:
  mwis::local_search::Cooling cooling_;
  mwis::local_search::Annealing search_;
  double unit_;
};

std::unique_ptr<Search> make_search(const graph::ConflictGraph& graph, const graph::IndependentSet& start,
                                    const InitsolOptions& options, Random random, const Deadline& deadline) {
  if (options.method == Method::tabu) return std::make_unique<TabuStart>(graph, start, options, random);
  return std::make_unique<AnnealedStart>(graph, start, options, random, deadline);
}

// The best parts of all: two starts of random-33k differ by 0.1 to 0.3 %, and together gain 0.1 %.
graph::IndependentSet recombined(const graph::ConflictGraph& graph,
                                 const std::vector<std::unique_ptr<Search>>& searches) {
  graph::IndependentSet set = searches.front()->best();
  for (std::size_t i = 1; i < searches.size(); ++i)
    set = mwis::local_search::recombine(graph, searches[i]->best(), set);
  return set;
}

double progress_of(std::int64_t done, const InitsolOptions& options, const Deadline& deadline) {
  const double by_iterations = static_cast<double>(done) / static_cast<double>(options.iterations);
  const double left = deadline.remaining();
  const double by_time = std::isfinite(left) ? deadline.elapsed() / (deadline.elapsed() + std::max(left, 0.0)) : 0;
  return std::min(1.0, std::max(by_iterations, by_time));
}

}  // namespace

InitsolResult find_initial_solution(const graph::ConflictGraph& graph, std::span<const double> quality,
                                    const InitsolOptions& options, const Deadline& deadline,
                                    const std::function<void(const InitsolProgress&)>& report) {
  const std::vector<double> vertex_merits = merits(graph, options.order, quality);
  InitsolResult result;
  const graph::IndependentSet first = greedy(graph, vertex_merits);
  result.greedy_weight = result.weight = graph::total_weight(first, graph);
  if (options.iterations == 0 || deadline.passed() || graph.edge_count() == 0) {
    result.solution = first;
    return result;
  }

  std::vector<std::unique_ptr<Search>> searches(static_cast<std::size_t>(options.starts));
  parallel_for(options.starts, 1, [&](std::int64_t i) {
    // Even streams of the seed make the starts, odd ones search.
    const Random random(options.seed, static_cast<std::uint64_t>(2 * i + 1));
    searches[i] = make_search(graph, start_solution(graph, vertex_merits, options, i), options, random, deadline);
  });
  const auto leader = [&] {
    return std::ranges::max_element(searches, {}, [](const auto& search) { return search->best_weight(); })->get();
  };
  // Of the last round only some, where time ran out in it.
  const auto moves_made = [&] {
    std::int64_t sum = 0;
    for (const auto& search : searches) sum += search->moves();
    return sum;
  };
  const std::int64_t round = std::clamp<std::int64_t>(options.iterations / least_rounds, 1, most_moves_a_round);
  const std::int64_t iterations = options.method == Method::descend ? 0 : options.iterations;
  for (std::int64_t done = 0; done < iterations && !deadline.passed();) {
    const std::int64_t moves = std::min(round, iterations - done);
    const double progress = progress_of(done, options, deadline);
    parallel_for(options.starts, 1, [&](std::int64_t i) { searches[i]->run(moves, progress, deadline); });
    done += moves;
    if (report && leader()->best_weight() > result.weight) {
      result.weight = leader()->best_weight();
      report({moves_made(), result.weight});
    }
    if (std::ranges::all_of(searches, [&](const auto& search) { return search->moves() < done; })) break;
  }
  result.iterations = moves_made();
  mwis::ground::SolutionState best(graph, recombined(graph, searches));
  best.make_maximal();  // with vertices of weight 0
  result.solution = best.to_set();
  result.weight = best.weight();
  return result;
}

}  // namespace hexpipe::initsol
