#include "tools/initsol/initsol.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "common/mwis/local_search/annealing.hpp"
#include "common/mwis/local_search/recombination.hpp"
#include "common/mwis/local_search/remainder.hpp"
#include "common/mwis/local_search/short_coolings.hpp"
#include "common/run/parallel.hpp"
#include "common/run/progress.hpp"

namespace hexpipe::initsol {
namespace {

// Moves between two checks of which start is ahead; they take some milliseconds.
constexpr std::int64_t most_moves_a_round = 1000;
// A search with few iterations cools down in at least this many steps.
constexpr std::int64_t least_rounds = 100;

// Annealing of graphs of this many vertices tries first whether cooling slowly will gain anything (tries_first).
// Smaller ones cool in a tenth of a second.
constexpr std::int32_t least_to_try = 2000;
// On graphs of hexes, a quarter of a move a vertex, begun in the middle of the temperatures, gains 96 to 100 % of what
// 15 moves gain over the first local optimum, in a tenth of the time: 0.141 of 0.145 % on mambo-m1, 0.347 of 0.356 % on
// spot. On random-33k it gains 6.6 of 8.8 %, on block-28k 0.70 of 0.96 %. Such graphs are recognized by what a second
// trial gains, or by how far the first local optimum is from the best; and by what a third gains: on a scan of spot the
// first optimum is as far from the best, yet cooling for 90 s found 0.001 % more than the trials had.
constexpr double moves_a_vertex_of_trial = 0.25, least_gain_of_trial = 1e-4, far_from_optimum = 5e-3;
// Trials of graphs of fewer vertices are longer: with a quarter of a move a vertex, six of 20 graphs of hexes of 2,000
// to 20,000 vertices lose 0.01 to 0.4 % on one of three seeds, with one move a vertex three of them 0.01 to 0.02 %.
constexpr std::int32_t few_vertices = 20000;
constexpr double moves_a_vertex_of_few = 1;
// In a run on each of a few graphs a second trial gained at most a tenth of what the first gained (random-33k), on
// graphs of hexes a twentieth. So it is made only after a gain that leaves it enough. On mambo-m6 the first gains 0.011
// %, and a second 0.0003 % in 2.6 s.
constexpr double least_gain_before_second_trial = 5 * least_gain_of_trial;
// Before graphs of more vertices cool slowly, which takes half a minute, a fourth trial, twice as long as the third,
// has to gain as much. On spot of 121,000 vertices the third gained 0.0103 %, a fourth nothing, and cooling slowly
// 0.0003 %.
constexpr std::int32_t many_vertices = 65536;
// How many times the work of kicks short coolings do beside them. On auctions (in608) kicks find what they do not.
constexpr double coolings_to_kicks = 3;

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
  // `progress`, from 0 to 1, is the share used of the iterations or of the time.
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

// One long cooling by kicks. Where short coolings suit the graph, they do as much work beside it, and several times as
// much in a given time; given temperatures leave them out, because they find their own.
class AnnealedStart : public Search {
 public:
  AnnealedStart(const graph::ConflictGraph& graph, const graph::IndependentSet& start, const InitsolOptions& options,
                Random random, const Deadline& deadline)
      : search_(graph, start, random, deadline), unit_(search_.mean_weight()) {
    cooling_ = mwis::local_search::Cooling::for_chosen(search_.chosen_count());
    cooling_.hot = options.hot.value_or(cooling_.hot);
    cooling_.cold = options.cold.value_or(cooling_.cold);
    const bool as_usual = !options.hot && !options.cold;
    if (as_usual && mwis::local_search::ShortCoolings::suit(graph, search_.chosen_count()))
      short_coolings_.emplace(graph, start, Random(random.next()));
  }
  void run(std::int64_t moves, double progress, const Deadline& deadline) override {
    const std::int64_t before = search_.touched();
    search_.run(moves, unit_ * cooling_.at(progress), deadline);
    if (!short_coolings_) return;
    const double times = std::isfinite(deadline.remaining()) ? coolings_to_kicks : 1;
    short_coolings_->run(times * static_cast<double>(search_.touched() - before), deadline);
  }
  std::int64_t moves() const override { return search_.kicks(); }
  std::int64_t best_weight() const override {
    return short_coolings_ ? std::max(search_.best_weight(), short_coolings_->best_weight()) : search_.best_weight();
  }
  graph::IndependentSet best() const override {
    const bool is_ahead = short_coolings_ && short_coolings_->best_weight() > search_.best_weight();
    return is_ahead ? short_coolings_->best() : search_.best();
  }

 private:
  mwis::local_search::Cooling cooling_;
  mwis::local_search::Annealing search_;
  std::optional<mwis::local_search::ShortCoolings> short_coolings_;
  double unit_;
};

std::unique_ptr<Search> make_search(const graph::ConflictGraph& graph, const graph::IndependentSet& start,
                                    const InitsolOptions& options, Random random, const Deadline& deadline) {
  if (options.method == Method::tabu) return std::make_unique<TabuStart>(graph, start, options, random);
  return std::make_unique<AnnealedStart>(graph, start, options, random, deadline);
}

// Combines the best regions of all: two starts of random-33k differ by 0.1 to 0.3 %; combining them gains 0.1 %.
graph::IndependentSet recombined(const graph::ConflictGraph& graph,
                                 const std::vector<std::unique_ptr<Search>>& searches) {
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

std::int64_t iterations_for(const graph::ConflictGraph& graph, const InitsolOptions& options) {
  if (options.method == Method::descend) return 0;
  std::int64_t by_vertices = 0;
  if (__builtin_mul_overflow(options.iterations_a_vertex, std::max(1, graph.vertex_count()), &by_vertices))
    return options.iterations;
  return std::min(options.iterations, by_vertices);
}

using Report = std::function<void(const InitsolProgress&)>;

// Searches from all starts, which make the same number of moves.
class Starts {
 public:
  // From start(i) for each i.
  Starts(const graph::ConflictGraph& graph, const std::function<graph::IndependentSet(std::int64_t)>& start,
         const InitsolOptions& options, const Deadline& deadline, const Report& report)
      : graph_(graph), deadline_(deadline), report_(report), searches_(static_cast<std::size_t>(options.starts)) {
    parallel_for(options.starts, 1, [&](std::int64_t i) {
      // Even streams of the seed make the starts, odd ones search.
      const Random random(options.seed, static_cast<std::uint64_t>(2 * i + 1));
      searches_[i] = make_search(graph, start(i), options, random, deadline);
    });
  }

  // Makes up to so many moves from each start. Temperatures fall from that at `progress` to the last one.
  void run(std::int64_t moves, double progress = 0) {
    const std::int64_t round = std::clamp<std::int64_t>(moves / least_rounds, 1, most_moves_a_round);
    Step step(nullptr);
    for (std::int64_t done = 0; done < moves && !deadline_.passed(); done += round) {
      const double share = progress_of(done, moves, deadline_);
      step.reach(share);
      if (!make_moves(std::min(round, moves - done), progress + (1 - progress) * share)) break;
    }
  }
  // Of the best start; before any moves, that of a local optimum.
  std::int64_t weight() const { return leader().best_weight(); }
  InitsolResult result() const {
    return {.solution = recombined(graph_, searches_), .weight = weight(), .iterations = moves_made()};
  }

 private:
  // Whether a start made all moves it was asked for.
  bool make_moves(std::int64_t moves, double progress) {
    asked_ += moves;
    parallel_for(std::ssize(searches_), 1, [&](std::int64_t i) { searches_[i]->run(moves, progress, deadline_); });
    if (weight() > reported_) {
      reported_ = weight();
      report_({moves_made(), reported_, [&] { return leader().best(); }});
    }
    return std::ranges::any_of(searches_, [&](const auto& search) { return search->moves() >= asked_; });
  }
  const Search& leader() const {
    return **std::ranges::max_element(searches_, {}, [](const auto& search) { return search->best_weight(); });
  }
  // If time ran out in the last round, only some of its moves were made.
  std::int64_t moves_made() const {
    std::int64_t sum = 0;
    for (const auto& search : searches_) sum += search->moves();
    return sum;
  }

  const graph::ConflictGraph& graph_;
  const Deadline& deadline_;
  const Report& report_;
  std::vector<std::unique_ptr<Search>> searches_;
  std::int64_t reported_ = 0, asked_ = 0;
};

std::int64_t moves_of_trial(const graph::ConflictGraph& graph) {
  const bool is_small = graph.vertex_count() < few_vertices;
  return static_cast<std::int64_t>((is_small ? moves_a_vertex_of_few : moves_a_vertex_of_trial) * graph.vertex_count());
}

// Whether cooling slowly will find more than quick trials have, which are short coolings from the middle of the
// temperatures. From the second on they are made only where a doubt is left. The third is twice as long as the others.
bool gains_after_trials(Starts& starts, const graph::ConflictGraph& graph) {
  const std::int64_t moves = moves_of_trial(graph);
  const auto gains = [&](std::int64_t before, double least) {
    return static_cast<double>(starts.weight() - before) > least * static_cast<double>(before);
  };
  const std::int64_t optimum = starts.weight();
  starts.run(moves, 0.5);
  if (!gains(optimum, least_gain_before_second_trial)) return false;
  const std::int64_t first = starts.weight();
  starts.run(moves, 0.5);
  if (!gains(first, least_gain_of_trial) && !gains(optimum, far_from_optimum)) return false;
  const std::int64_t second = starts.weight();
  starts.run(2 * moves, 0.5);
  if (!gains(second, least_gain_of_trial)) return false;
  if (graph.vertex_count() <= many_vertices) return true;
  const std::int64_t third = starts.weight();
  starts.run(4 * moves, 0.5);
  return gains(third, least_gain_of_trial);
}

InitsolResult search(const graph::ConflictGraph& graph, const std::function<graph::IndependentSet(std::int64_t)>& start,
                     const InitsolOptions& options, const Deadline& deadline, const Report& report) {
  Starts starts(graph, start, options, deadline, report);
  const bool is_tried = options.method == Method::anneal && options.tries_first && graph.vertex_count() >= least_to_try;
  if (!is_tried || gains_after_trials(starts, graph)) starts.run(iterations_for(graph, options));
  return starts.result();
}

InitsolResult search_remainder(const graph::ConflictGraph& graph,
                               const std::function<graph::IndependentSet(std::int64_t)>& start,
                               const InitsolOptions& options, const Deadline& deadline, const Report& report) {
  const mwis::local_search::Remainder rest(graph, deadline);
  InitsolResult result;
  result.complete = rest.is_solved();
  if (!result.complete)
    result = search(
        rest.graph(), [&](std::int64_t i) { return rest.project(start(i)); }, options, deadline,
        [&](const InitsolProgress& now) {
          report({now.iteration, now.weight + rest.offset(), [&] { return rest.lift(now.solution()); }});
        });
  result.solution = rest.lift(result.solution);
  if (result.complete) report({0, graph::total_weight(result.solution, graph), [&] { return result.solution; }});
  return result;
}

// Vertices of quads follow candidates by themselves, and so need no kicks of their own: on spot at size 0.065, half as
// many kicks end at the same weight.
InitsolOptions with_kicks_of_candidates(InitsolOptions options, const graph::ConflictGraph& graph) {
  if (options.quads == 0 || options.iterations_a_vertex == InitsolOptions{}.iterations_a_vertex) return options;
  const std::int32_t candidates = graph.vertex_count() - options.quads;
  options.iterations_a_vertex =
      std::max<std::int64_t>(1, options.iterations_a_vertex * candidates / graph.vertex_count());
  return options;
}

}  // namespace

InitsolResult find_initial_solution(const graph::ConflictGraph& graph, std::span<const double> quality,
                                    const InitsolOptions& given, const Deadline& deadline, const Report& report) {
  const InitsolOptions options = with_kicks_of_candidates(given, graph);
  const std::vector<double> vertex_merits = merits(graph, options.order, quality, options.quads);
  const auto start = [&](std::int64_t i) { return start_solution(graph, vertex_merits, options, i); };
  const graph::IndependentSet first = start(0);
  const std::int64_t greedy_weight = graph::total_weight(first, graph);
  std::int64_t reported = greedy_weight;
  const Report report_better = [&](const InitsolProgress& now) {
    if (!report || now.weight <= reported) return;
    reported = now.weight;
    report(now);
  };
  InitsolResult result;
  if (options.iterations > 0 && !deadline.passed() && graph.edge_count() > 0)
    result = options.reduce ? search_remainder(graph, start, options, deadline, report_better)
                            : search(graph, start, options, deadline, report_better);
  mwis::ground::SolutionState best(graph, result.solution);
  best.make_maximal();  // with vertices of weight 0
  const bool better = best.weight() > greedy_weight;
  result.solution = better ? best.to_set() : first;
  result.weight = better ? best.weight() : greedy_weight;
  result.greedy_weight = greedy_weight;
  return result;
}

}  // namespace hexpipe::initsol
