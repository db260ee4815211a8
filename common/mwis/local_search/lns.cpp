#include "common/mwis/local_search/lns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "common/mwis/local_search/fragment.hpp"
#include "common/mwis/local_search/fragment_solver.hpp"
#include "common/mwis/local_search/remainder.hpp"
#include "common/mwis/local_search/schedule.hpp"
#include "common/mwis/local_search/short_coolings.hpp"
#include "common/mwis/local_search/stop_rule.hpp"
#include "common/mwis/reduce/sample.hpp"
#include "common/run/parallel.hpp"
#include "common/run/progress.hpp"

namespace hexpipe::mwis::local_search {
namespace {

// For annealing a fragment for the first time; each time that it does not help, the next one is slower by as much, up
// to `most_kicks`. 3 beat 20 on random-33k and vr60k after 8 and 40 s, and on 200,000 points at random after 20 s; 20
// beat 60. 1 is as good as 3 after 8 s, but misses the optimum of block-28k.
constexpr std::int64_t first_kicks = 3, most_kicks = 320;  // a vertex
// A cooling of this many kicks a vertex is the measure of the whole work.
constexpr double kicks_of_a_cooling = 20;
// Annealed fragments may be this many times as large as wanted. Only hubs make them so large, and a hub can be
// replaced by all its neighbours in no other way.
constexpr std::size_t hub_factor = 16;
// When exact fragments have gone over all of a large graph this often, the rule expects no more of the rest than of the
// last half. On graphs of hexes nearly all gains come from the first time.
constexpr double times_over_graph = 4;
// The whole work of the stop rule (--worth), in vertices that are cooled once: all of them, 0.4 to 5 times. Large
// graphs gain for longer: on random-33k, 0.4 times would end at 10,100,430 after 2 s of lns, which finds 10,129,518 in
// a minute. On a lattice of 6 x 6 x 6 hexes (5,300 vertices), whose best solution is found at once, 0.4 times are half
// a second.
double vertices_of_whole(const graph::ConflictGraph& graph) {
  constexpr double vertices_a_cooling = 12500, least = 0.4, most = 5;
  const auto vertices = static_cast<double>(graph.vertex_count());
  return vertices * std::clamp(vertices / vertices_a_cooling, least, most);
}
// The rule judges once the search has worked as long as annealing this many vertices once takes. Fragments begin
// anywhere, so what they gain says something about the rest, too: of 1.2 million candidates of a CAD model, the last
// gain comes within a twentieth of a cooling. In a large graph one place is a smaller share of the weight, and less of
// the work is enough: 6,000 vertices end where 15,000 did on seven graphs of hexes with three seeds each, 5,000 lose
// 0.0004 % at most. 3,750 are too few, because the first fragments of each operator take as much. Where exact
// fragments have gone over all of the graph before, and have gained next to nothing, it judges then: on 22 graphs of
// hexes of 2,100 to 198,000 vertices no gain came later. block-28k, random-33k and sphere-56k gain in the first pass
// and go on to gain.
double vertices_of_sample(const graph::ConflictGraph& graph) {
  const double sample = graph.vertex_count() > reduce::most_of_a_small_graph ? 6000 : 15000;
  return std::min(sample, vertices_of_whole(graph));
}

// On C2000.9 all gains of the last seconds come from searching the whole graph anew, and they are rare. On auctions
// (in608) fragments that are solved exactly or annealed are needed, too.
constexpr OperatorSelection::LeastShares least_shares_beside_short_coolings{0.1, 0.1, 0.6};

class Lns {
 public:
  Lns(const graph::ConflictGraph& graph, const graph::IndependentSet& initial, const LnsOptions& options,
      const Deadline& deadline, const std::function<void(const LnsProgress&)>& report, LnsMemory* memory = nullptr,
      std::int64_t decided = 0)
      : options_(options),
        deadline_(deadline),
        report_(report),
        memory_(memory),
        state_(graph, initial),
        grower_(state_, Random(options.seed, 1)),
        schedules_{
            Schedule(graph.weights.size(), options.fragment_size, options.largest_fragment, Random(options.seed, 0)),
            Schedule(graph.weights.size(), options.annealed_fragment, options.annealed_fragment,
                     Random(options.seed, 2)),
            Schedule(graph.weights.size(), options.recombined_fragment, options.recombined_fragment,
                     Random(options.seed, 3))},
        selection_(operators_of(options)),
        stop_rule_(options.worth * static_cast<double>(total_weight(initial, graph) + decided),
                   work_of_cooling(graph, vertices_of_sample(graph)),
                   work_of_cooling(graph, vertices_of_whole(graph))) {
    state_.make_maximal();
    stop_rule_.record(0, state_.weight());
    const std::int64_t chosen = std::ssize(state_.to_set());
    usual_ = Cooling::for_chosen(chosen);
    if (ShortCoolings::suit(graph, chosen)) {
      short_coolings_.emplace(graph, graph::IndependentSet(), Random(options.seed, ~std::uint64_t{0}));
      selection_ = OperatorSelection(operators_of(options), least_shares_beside_short_coolings);
    }
    if (memory_ != nullptr) recall();
    if (memory_ == nullptr) begin_step();
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v) {
      if (!state_.contains(v)) continue;
      wait(v);
      // Other places wait as if one fragment had been tried there.
      if (!options.first_places.empty() && !options.first_places[v]) schedule_of(Operator::exact).retire(v);
    }
    const auto largest = std::min<std::size_t>(graph.weights.size(), options.recombined_fragment);
    selection_.expect(Operator::recombine,
                      static_cast<double>(options.free_running ? 1 : batch_of(Operator::recombine)) *
                          work_of_kicks(graph, static_cast<double>(first_kicks) * static_cast<double>(largest)));
  }

  LnsResult run() {
    if (options_.free_running)
      run_free();
    else
      run_rounds();
    state_.make_maximal();
    if (memory_ != nullptr) remember();
    return {state_.to_set(), state_.weight(), iterations_, improvements_, is_complete()};
  }

 private:
  static double work_of_kicks(const graph::ConflictGraph& graph, double kicks) {
    return kicks * FragmentSolver::work_a_kick(graph);
  }
  static double work_of_cooling(const graph::ConflictGraph& graph, double vertices) {
    return work_of_kicks(graph, kicks_of_a_cooling * vertices);
  }
  bool is_complete() const { return closed_ == state_.graph().vertex_count(); }
  bool goes_on() const {
    return begun_ < options_.iterations && state_.weight() < options_.target && !is_complete() &&
           !stop_rule_.is_done() && !deadline_.passed();
  }
  static std::vector<Operator> operators_of(const LnsOptions& options) {
    std::vector<Operator> operators{Operator::exact};
    if (options.annealed_fragment > 0) operators.push_back(Operator::anneal);
    if (options.recombined_fragment > 0) operators.push_back(Operator::recombine);
    return operators;
  }
  // How many times its work the search needs at most to see enough of the graph.
  double times_left() const {
    const std::int32_t vertices = state_.graph().vertex_count();
    if (vertices <= reduce::most_of_a_small_graph || seen_ == 0) return std::numeric_limits<double>::infinity();
    return times_over_graph * static_cast<double>(vertices) / seen_;
  }
  Schedule& schedule_of(Operator op) { return schedules_[index_of(op)]; }
  const Schedule& schedule_of(Operator op) const { return schedules_[index_of(op)]; }
  void renew(std::int32_t v) {
    for (Schedule& schedule : schedules_) schedule.renew(v);
  }
  void wait(std::int32_t v) {
    for (Schedule& schedule : schedules_) schedule.wait(v);
  }

  // For the line of progress; a search that goes on in rounds has a step of its own.
  void begin_step() {
    step_.emplace(nullptr);
    if (std::isfinite(deadline_.remaining())) step_->usually_takes(deadline_.remaining());
    if (options_.iterations < LnsOptions{}.iterations) step_->expect(options_.iterations);
  }

  void recall() {
    for (const LnsMemory::Place& place : memory_->places)
      for (const Operator op : all_operators) {
        Schedule& schedule = schedule_of(op);
        const auto size =
            op == Operator::exact ? place.size : static_cast<std::uint32_t>(schedule.size_at(place.vertex));
        schedule.recall(place.vertex, place.tries[index_of(op)], size);
      }
    selection_.recall(memory_->operator_scores);
  }
  void remember() {
    memory_->places.clear();
    for (std::int32_t v = 0; v < state_.graph().vertex_count(); ++v) {
      if (!state_.contains(v)) continue;
      LnsMemory::Place& place = memory_->places.emplace_back();
      place.vertex = v;
      for (const Operator op : all_operators) place.tries[index_of(op)] = schedule_of(op).tries_at(v);
      place.size = static_cast<std::uint32_t>(schedule_of(Operator::exact).size_at(v));
    }
    memory_->operator_scores = selection_.scores();
  }

  void run_rounds() {
    std::vector<FragmentSolver> solvers(static_cast<std::size_t>(options_.batch));
    while (goes_on()) {
      const std::int64_t first = begun_;
      const std::int64_t size = grow_round(solvers);
      if (size == 0) return;
      parallel_for(size, 1, [&](std::int64_t i) {
        solvers[i].extract(grower_);
        solve(solvers[i], first + i);
      });
      grower_.let_go();
      for (std::int64_t i = 0; i < size; ++i) apply(solvers[i]);
      take_left_out();
    }
  }

  // Operators with larger fragments solve fewer at a time.
  std::int64_t batch_of(Operator op) const {
    constexpr std::array divisors{1, 4, 8};
    const int divisor = divisors[index_of(op)];
    return (options_.batch + divisor - 1) / divisor;
  }

  // Fills the round with fragments that do not touch each other.
  std::int64_t grow_round(std::vector<FragmentSolver>& solvers) {
    const Operator op = selection_.next();
    const std::int64_t batch = batch_of(op);
    const std::int64_t wanted = std::min(batch, options_.iterations - begun_);
    std::int64_t size = 0;
    while (size < wanted && grow(op, solvers[size], batch)) ++size;
    return size;
  }

  struct FreeRun {
    std::mutex mutex;
    std::condition_variable fragment_done;
    bool failed = false;
  };

  // Each thread takes a fragment, solves it beside the others and puts it back, on its own. An exception in one thread
  // ends all, because nobody else would wake the threads that wait for its fragment.
  void run_free() {
    FreeRun run;
    parallel_for(thread_count(), 1, [&](std::int64_t) {
      std::unique_lock lock(run.mutex);
      try {
        take_turns(run, lock);
      } catch (...) {
        if (!lock.owns_lock()) lock.lock();
        run.failed = true;
        run.fragment_done.notify_all();
        throw;
      }
      run.fragment_done.notify_all();
    });
  }

  // One thread. It holds the lock except while it solves.
  void take_turns(FreeRun& run, std::unique_lock<std::mutex>& lock) {
    FragmentSolver solver;
    while (!run.failed && goes_on()) {
      if (!grow(selection_.next(), solver, options_.batch)) {
        if (begun_ == iterations_) return;
        run.fragment_done.wait(lock);
        continue;
      }
      solver.extract(grower_);
      const std::int64_t index = begun_ - 1;
      const std::int64_t budget = budget_for(solver);
      lock.unlock();
      solver.solve(budget, random_for(index), deadline_, usual_, searched_beside());
      lock.lock();
      grower_.let_go(solver.fragment());
      apply(solver);
      take_left_out();
      run.fragment_done.notify_all();
      // Threads that share a small component would keep each other from seeing all of it for ever.
      if (solver.fragment().is_cut_off && begun_ > iterations_) run.fragment_done.wait(lock);
    }
  }

  // Grows a fragment from the next free seed. False if there is none within this many.
  bool grow(Operator op, FragmentSolver& solver, std::int64_t most_postponed) {
    Schedule& schedule = schedule_of(op);
    postponed_.clear();
    bool grown = false;
    while (!grown && std::ssize(postponed_) < most_postponed) {
      const auto seed = schedule.take();
      if (!seed) break;
      if (!state_.contains(*seed)) continue;
      if (!grower_.is_free(*seed)) {
        postponed_.push_back(*seed);
        continue;
      }
      const std::size_t size = schedule.size_at(*seed);
      const std::size_t limit =
          op == Operator::exact ? std::min(options_.largest_fragment, 2 * size) : hub_factor * size;
      solver.begin(op);
      grower_.grow(*seed, size, limit, solver.fragment());
      ++begun_;
      grown = true;
    }
    for (const std::int32_t v : postponed_) schedule.wait(v);
    return grown;
  }

  ShortCoolings* searched_beside() { return short_coolings_ ? &*short_coolings_ : nullptr; }

  Random random_for(std::int64_t index) const { return {options_.seed, static_cast<std::uint64_t>(4 + index)}; }

  // The next annealing of a place where annealing did not help is slower.
  std::int64_t budget_for(const FragmentSolver& solver) const {
    if (solver.used_operator() == Operator::exact) return options_.node_limit;
    const std::int64_t tries = schedule_of(solver.used_operator()).tries_at(solver.fragment().released.front());
    return std::min(first_kicks * (1 + tries), most_kicks);
  }

  void solve(FragmentSolver& solver, std::int64_t index) {
    solver.solve(budget_for(solver), random_for(index), deadline_, usual_, searched_beside());
  }

  void apply(const FragmentSolver& solver) {
    ++iterations_;
    if (step_) step_->advance();
    const std::int64_t before = state_.weight();
    if (put_back(solver) && state_.weight() > before) {
      ++improvements_;
      if (report_)
        report_({iterations_, state_.weight(), solver.fragment().vertices, [this] { return state_.to_set(); }});
      renew_around(solver);
    } else {
      hand_over(solver);
      retire_around(solver);
    }
    selection_.record(solver.used_operator(), solver.work(), static_cast<double>(state_.weight() - before));
    work_ += std::max(solver.work(), OperatorSelection::least_work);
    // Half of a fragment's vertices have their surroundings in it.
    if (solver.used_operator() == Operator::exact) seen_ += static_cast<double>(solver.fragment().vertices.size()) / 2;
    const bool has_seen_all = seen_ >= state_.graph().vertex_count();
    stop_rule_.record(work_, state_.weight(), times_left(), has_seen_all);
    if (solver.complete() && solver.fragment().whole_component) close(solver.fragment());
  }

  // False if nothing was changed, because a fragment that another thread (free running) put back nearby is in conflict.
  bool put_back(const FragmentSolver& solver) {
    const auto& vertices = solver.fragment().vertices;
    removed_.clear();
    added_.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (state_.contains(vertices[i]) && !solver.chooses(i)) removed_.push_back(vertices[i]);
    for (const std::int32_t v : removed_) state_.remove(v);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (solver.chooses(i) && state_.tightness(vertices[i]) != 0) {
        for (const std::int32_t v : removed_) state_.add(v);
        return false;
      }
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (solver.chooses(i) && !state_.contains(vertices[i])) add(vertices[i]);
    // The result of a search that ended at its limit need not be maximal.
    for (const std::int32_t v : vertices)
      if (!state_.contains(v) && state_.tightness(v) == 0) add(v);
    for (const std::int32_t v : removed_)
      for (const std::int32_t u : state_.graph().neighbours_of(v))
        if (!state_.contains(u) && state_.tightness(u) == 0) left_out_.push_back(u);
    return true;
  }

  // A vertex that was in no fragment may have lost its last chosen neighbour. Fragments grow from chosen vertices and
  // would never reach it.
  void take_left_out() {
    std::ranges::stable_sort(left_out_, std::ranges::greater(),
                             [&](std::int32_t v) { return state_.graph().weights[v]; });
    std::erase_if(left_out_, [&](std::int32_t v) {
      if (state_.contains(v) || state_.tightness(v) != 0) return true;
      if (!grower_.is_free(v)) return false;
      state_.add(v);
      renew(v);
      return true;
    });
  }
  void add(std::int32_t v) {
    state_.add(v);
    added_.push_back(v);
  }

  // Vertices that came in without a gain are seeds as well: new ones for the other operators. The operator that brought
  // them counts one more try; otherwise it would stay there for ever where weights are equal.
  void hand_over(const FragmentSolver& solver) {
    const std::int32_t seed = solver.fragment().released.front();
    Schedule& own = schedule_of(solver.used_operator());
    const std::uint32_t tries = own.tries_at(seed) + 1;
    for (const std::int32_t v : added_) {
      renew(v);
      own.recall(v, tries, static_cast<std::uint32_t>(own.size_at(seed)));
    }
  }

  // Everything that could be better now, because it is in the fragment or could share one with it.
  void renew_around(const FragmentSolver& solver) {
    const Fragment& fragment = solver.fragment();
    Schedule& exact = schedule_of(Operator::exact);
    const std::size_t size = exact.size_at(fragment.released.front());
    for (const std::int32_t v : fragment.vertices) {
      if (!state_.contains(v)) continue;
      exact.set_size(v, size);
      renew(v);
    }
    for (const std::int32_t v : fragment.frontier) renew(v);
  }

  // For the inner half of the fragment, the surroundings are solved, too.
  void retire_around(const FragmentSolver& solver) {
    const auto& released = solver.fragment().released;
    const std::size_t inner = (released.size() + 1) / 2;
    Schedule& schedule = schedule_of(solver.used_operator());
    for (std::size_t i = 0; i < inner; ++i) {
      if (!state_.contains(released[i])) continue;
      if (solver.used_operator() == Operator::exact && solver.complete())
        schedule.enlarge(released[i]);
      else if (solver.used_operator() == Operator::exact)
        schedule.shrink(released[i]);
      schedule.retire(released[i]);
    }
  }

  void close(const Fragment& fragment) {
    closed_ += static_cast<std::int32_t>(fragment.vertices.size());
    for (const std::int32_t v : fragment.vertices)
      for (Schedule& schedule : schedules_) schedule.close(v);
  }

  const LnsOptions& options_;
  const Deadline& deadline_;
  const std::function<void(const LnsProgress&)>& report_;
  LnsMemory* const memory_;
  ground::SolutionState state_;
  FragmentGrower grower_;
  std::array<Schedule, all_operators.size()> schedules_;  // by operator
  OperatorSelection selection_;
  StopRule stop_rule_;
  double work_ = 0;  // of all fragments
  double seen_ = 0;  // vertices in the inner halves of exact fragments, counted as often as they were there
  Cooling usual_;    // temperatures for this graph
  std::optional<ShortCoolings> short_coolings_;  // if they suit this graph
  std::vector<std::int32_t> postponed_, removed_, added_, left_out_;
  std::int64_t begun_ = 0, iterations_ = 0;  // fragments grown, and fragments put back
  std::int64_t improvements_ = 0;
  std::optional<Step> step_;
  std::int32_t closed_ = 0;  // vertices of components that are solved completely
};

Deadline earlier(const Deadline& deadline, double seconds) {
  return std::isfinite(deadline.remaining()) ? Deadline(deadline.remaining() - seconds) : Deadline();
}

// Vertices that reductions made of several ones count as first places.
std::vector<bool> of_remainder(const std::vector<bool>& of_graph, const Remainder& rest) {
  std::vector<bool> result(of_graph.empty() ? 0 : rest.graph().weights.size(), true);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto v = static_cast<std::int32_t>(i);
    const auto original = rest.originals(std::span(&v, 1));
    if (!original.empty()) result[i] = of_graph[original.front()];
  }
  return result;
}

// Reports solutions of the remainder as solutions of the whole graph once they are better than the start. At first they
// are worse, because the reductions decided differently and the search has to catch up.
LnsResult search_remainder(const graph::ConflictGraph& graph, const graph::IndependentSet& start,
                           const LnsOptions& options, const Deadline& deadline,
                           const std::function<void(const LnsProgress&)>& report) {
  const Remainder rest(graph, deadline);
  std::int64_t best = total_weight(start, graph);
  const auto report_whole = [&](const LnsProgress& now) {
    if (!report || now.weight + rest.offset() <= best) return;
    best = now.weight + rest.offset();
    const std::vector<std::int32_t> fragment = rest.originals(now.fragment);
    report({now.iteration, best, fragment, [&] { return rest.lift(now.solution()); }});
  };
  LnsOptions rest_options = options;
  rest_options.target -= rest.offset();
  rest_options.first_places = of_remainder(options.first_places, rest);
  LnsResult result;
  result.complete = rest.is_solved();
  if (!result.complete)
    result = Lns(rest.graph(), rest.project(start), rest_options, deadline, report_whole, nullptr, rest.offset()).run();
  result.solution = rest.lift(result.solution);
  result.weight = total_weight(result.solution, graph);
  if (result.complete)
    report_whole({result.iterations, result.weight - rest.offset(), {}, [&] { return rest.project(result.solution); }});
  return result;
}

}  // namespace

LnsResult improve_by_lns(const graph::ConflictGraph& graph, const graph::IndependentSet& initial,
                         const LnsOptions& options, const Deadline& deadline,
                         const std::function<void(const LnsProgress&)>& report) {
  const Stopwatch watch;
  ground::SolutionState state(graph, initial);
  state.make_maximal();
  const graph::IndependentSet start = state.to_set();
  // The lift at the end takes as long as this did: a quarter of a second at 33 million edges.
  const Deadline before_lift = earlier(deadline, watch.seconds());
  const bool idle = options.iterations == 0 || state.weight() >= options.target || deadline.passed();
  LnsResult result = options.reduce && !idle ? search_remainder(graph, start, options, before_lift, report)
                                             : Lns(graph, start, options, deadline, report).run();
  if (result.weight < state.weight()) {
    result.solution = start;
    result.weight = state.weight();
  }
  return result;
}

LnsResult continue_lns(const graph::ConflictGraph& graph, const graph::IndependentSet& initial,
                       const LnsOptions& options, const Deadline& deadline, LnsMemory& memory,
                       const std::function<void(const LnsProgress&)>& report) {
  return Lns(graph, initial, options, deadline, report, &memory).run();
}

}  // namespace hexpipe::mwis::local_search
