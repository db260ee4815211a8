#include "tools/initsol/initsol.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "common/mwis/local_search/recombination.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::initsol {
namespace {

// Moves of a round, after which progress is reported: some milliseconds.
constexpr std::int64_t most_moves_a_round = 1000;
// A short search cools down in as many steps as it has iterations, a longer one in at least this many.
constexpr std::int64_t least_rounds = 100;

graph::IndependentSet start_solution(const graph::ConflictGraph& graph, std::vector<double> merits, std::uint64_t seed,
                                     std::int64_t index) {
  if (index > 0) {
    Random random(seed, static_cast<std::uint64_t>(2 * index));
    for (double& merit : merits) merit *= random.uniform(0.8, 1.2);
  }
  return greedy(graph, merits);
}

class Search {
 public:
  virtual ~Search() = default;
  // `progress`: the share of the iterations or of the time that was used, from 0 to 1.
  virtual void run(std::int64_t moves, double progress, const Deadline& deadline) = 0;
  virtual std::int64_t moves() const = 0;
  virtual std::int64_t best_weight() const = 0;
  virtual graph::IndependentSet best() const = 0;
};

class TabuStart : public Search {
 public:
  TabuStart(const graph::ConflictGraph& graph, const graph::IndependentSet& start, const TabuOptions& options,
            Random random)
      : search_(graph, start, options, random) {}
  void run(std::int64_t moves, double, const Deadline& deadline) override { search_.run(moves, deadline); }
  std::int64_t moves() const override { return search_.moves(); }
  std::int64_t best_weight() const override { return search_.best_weight(); }
  graph::IndependentSet best() const override { return search_.best(); }

 private:
  TabuSearch search_;
};

class AnnealedStart : public Search {
 public:
  AnnealedStart(const graph::ConflictGraph& graph, const graph::IndependentSet& start,
                const mwis::local_search::Cooling& cooling, Random random, const Deadline& deadline)
      : cooling_(cooling), search_(graph, start, random, deadline), unit_(search_.mean_weight()) {}
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

using Searches = std::vector<std::unique_ptr<Search>>;

Searches make_searches(const graph::ConflictGraph& graph, const std::vector<double>& merits,
                       const InitsolOptions& options, const Deadline& deadline) {
  Searches searches(static_cast<std::size_t>(options.starts));
  parallel_for(options.starts, 1, [&](std::int64_t i) {
    const graph::IndependentSet start = start_solution(graph, merits, options.seed, i);
    // Even streams of the seed make the starts, odd ones search.
    const Random random(options.seed, static_cast<std::uint64_t>(2 * i + 1));
    if (options.method == Method::tabu)
      searches[i] = std::make_unique<TabuStart>(graph, start, options.tabu, random);
    else
      searches[i] = std::make_unique<AnnealedStart>(graph, start, options.cooling, random, deadline);
  });
  return searches;
}

// A search whose time runs out makes fewer moves in its last round.
std::int64_t moves_made(const Searches& searches) {
  std::int64_t sum = 0;
  for (const auto& search : searches) sum += search->moves();
  return sum;
}

std::int64_t best_weight(const Searches& searches) {
  std::int64_t best = 0;
  for (const auto& search : searches) best = std::max(best, search->best_weight());
  return best;
}

// Takes the best parts of all searches. Two starts of random-33k differ by 0.1 to 0.3 %; recombined, they gain 0.1 %.
graph::IndependentSet recombined(const graph::ConflictGraph& graph, const Searches& searches) {
  graph::IndependentSet set = searches.front()->best();
  for (std::size_t i = 1; i < searches.size(); ++i)
    set = mwis::local_search::recombine(graph, searches[i]->best(), set);
  return set;
}

double progress_of(std::int64_t done, std::int64_t iterations, const Deadline& deadline) {
  const double by_iterations = static_cast<double>(done) / static_cast<double>(iterations);
  const double left = deadline.remaining();
  const double by_time = std::isfinite(left) ? deadline.elapsed() / (deadline.elapsed() + std::max(left, 0.0)) : 0;
  return std::min(1.0, std::max(by_iterations, by_time));
}

// All searches side by side, in rounds, until the iterations or the time are used up, or none of them can move.
void run_searches(Searches& searches, std::int64_t iterations, const Deadline& deadline,
                  const std::function<void()>& after_round) {
  const std::int64_t round = std::clamp<std::int64_t>(iterations / least_rounds, 1, most_moves_a_round);
  for (std::int64_t done = 0; done < iterations && !deadline.passed();) {
    const std::int64_t moves = std::min(round, iterations - done);
    const double progress = progress_of(done, iterations, deadline);
    parallel_for(static_cast<std::int64_t>(searches.size()), 1,
                 [&](std::int64_t i) { searches[i]->run(moves, progress, deadline); });
    done += moves;
    after_round();
    if (std::ranges::all_of(searches, [&](const auto& search) { return search->moves() < done; })) break;
  }
}

}  // namespace

InitsolResult find_initial_solution(const graph::ConflictGraph& graph, std::span<const double> quality,
                                    const InitsolOptions& options, const Deadline& deadline,
                                    const std::function<void(const InitsolProgress&)>& report) {
  const std::vector<double> vertex_merits = merits(graph, options.order, quality);
  InitsolResult result;
  result.solution = greedy(graph, vertex_merits);
  result.greedy_weight = result.weight = graph::total_weight(result.solution, graph);
  if (options.iterations == 0 || deadline.passed() || graph.edge_count() == 0) return result;

  Searches searches = make_searches(graph, vertex_merits, options, deadline);
  if (options.method != Method::descend)
    run_searches(searches, options.iterations, deadline, [&] {
      if (!report || best_weight(searches) <= result.weight) return;
      result.weight = best_weight(searches);
      report({moves_made(searches), result.weight});
    });
  result.iterations = moves_made(searches);
  mwis::ground::SolutionState best(graph, recombined(graph, searches));
  best.make_maximal();  // with vertices of weight 0
  result.solution = best.to_set();
  result.weight = best.weight();
  return result;
}

}  // namespace hexpipe::initsol
