#include "tools/lns/lns.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/mwis/exact_solver.hpp"
#include "common/mwis/kernel.hpp"
#include "common/run/parallel.hpp"
#include "tools/lns/fragment.hpp"
#include "tools/lns/schedule.hpp"

namespace hexpipe {
namespace {

class Lns {
 public:
  Lns(const ConflictGraph& graph, const IndependentSet& initial, const LnsOptions& options, const Deadline& deadline,
      const std::function<void(const LnsProgress&)>& report)
      : options_(options),
        deadline_(deadline),
        report_(report),
        state_(graph, initial),
        grower_(state_, Random(options.seed, 1)),
        schedule_(graph.weights.size(), options.fragment_size, options.largest_fragment, Random(options.seed, 0)),
        tasks_(static_cast<std::size_t>(options.batch)) {
    state_.make_maximal();
    for (std::int32_t v = 0; v < graph.vertex_count(); ++v)
      if (state_.contains(v)) schedule_.renew(v);
  }

  LnsResult run() {
    while (iterations_ < options_.iterations && !deadline_.passed() && grow_round()) {
      parallel_for(round_size_, 1, [&](std::int64_t i) { solve(tasks_[i]); });
      for (int i = 0; i < round_size_; ++i) apply(tasks_[i]);
    }
    state_.make_maximal();
    const bool complete = closed_ == state_.graph().vertex_count();
    return {state_.to_set(), state_.weight(), iterations_, improvements_, complete};
  }

 private:
  struct Task {
    Fragment fragment;
    DenseGraph graph;
    std::vector<bits::Word> chosen;
    ExactSolver solver;
    bool complete = false;
  };

  // Fills the round with fragments that do not touch each other; false when no seed is left.
  bool grow_round() {
    grower_.begin_round();
    round_size_ = 0;
    postponed_.clear();
    const auto wanted = static_cast<int>(std::min<std::int64_t>(options_.batch, options_.iterations - iterations_));
    while (round_size_ < wanted && std::ssize(postponed_) < options_.batch) {
      const auto seed = schedule_.take();
      if (!seed) break;
      if (!state_.contains(*seed)) continue;
      if (!grower_.is_free(*seed)) {
        postponed_.push_back(*seed);
        continue;
      }
      const std::size_t size = schedule_.size_at(*seed);
      grower_.grow(*seed, size, std::min(options_.largest_fragment, 2 * size), tasks_[round_size_++].fragment);
    }
    for (const std::int32_t v : postponed_) schedule_.wait(v);
    return round_size_ > 0;
  }

  void solve(Task& task) const {
    grower_.extract(task.fragment, task.graph, task.chosen);
    SearchBudget budget(options_.node_limit, &deadline_);
    task.complete = task.solver.solve(task.graph, task.chosen, budget);
  }

  void apply(const Task& task) {
    ++iterations_;
    const std::int64_t before = state_.weight();
    exchange(task);
    if (state_.weight() > before) {
      ++improvements_;
      if (report_) report_({iterations_, state_.weight()});
      renew_around(task);
    } else {
      retire_around(task);
    }
    if (task.complete && task.fragment.whole_component) {
      closed_ += static_cast<std::int32_t>(task.fragment.vertices.size());
      for (const std::int32_t v : task.fragment.vertices) schedule_.close(v);
    }
  }

  void exchange(const Task& task) {
    const auto& vertices = task.fragment.vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (state_.contains(vertices[i]) && !bits::test(task.chosen.data(), i)) state_.remove(vertices[i]);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (!state_.contains(vertices[i]) && bits::test(task.chosen.data(), i)) state_.add(vertices[i]);
    // What branch and bound found before its limit need not be maximal.
    for (const std::int32_t v : vertices)
      if (!state_.contains(v) && state_.tightness(v) == 0) state_.add(v);
  }

  // Everything that could be better now, because it is in the fragment or could share one with it.
  void renew_around(const Task& task) {
    const std::size_t size = schedule_.size_at(task.fragment.released.front());
    for (const std::int32_t v : task.fragment.vertices) {
      if (!state_.contains(v)) continue;
      schedule_.set_size(v, size);
      schedule_.renew(v);
    }
    for (const std::int32_t v : task.fragment.frontier) schedule_.renew(v);
  }

  // The inner half of the fragment has its surroundings solved too.
  void retire_around(const Task& task) {
    const auto& released = task.fragment.released;
    const std::size_t inner = (released.size() + 1) / 2;
    for (std::size_t i = 0; i < inner; ++i) {
      if (!state_.contains(released[i])) continue;
      if (task.complete)
        schedule_.enlarge(released[i]);
      else
        schedule_.shrink(released[i]);
      schedule_.retire(released[i]);
    }
  }

  const LnsOptions& options_;
  const Deadline& deadline_;
  const std::function<void(const LnsProgress&)>& report_;
  SolutionState state_;
  FragmentGrower grower_;
  Schedule schedule_;
  std::vector<Task> tasks_;
  std::vector<std::int32_t> postponed_;
  int round_size_ = 0;
  std::int64_t iterations_ = 0;
  std::int64_t improvements_ = 0;
  std::int32_t closed_ = 0;  // vertices of components that are solved to the end
};

Deadline earlier(const Deadline& deadline, double seconds) {
  return std::isfinite(deadline.remaining()) ? Deadline(deadline.remaining() - seconds) : Deadline();
}

// Of a time limit, reductions get a tenth.
Deadline share_for_reductions(const Deadline& deadline) {
  return std::isfinite(deadline.remaining()) ? Deadline(0.1 * deadline.remaining()) : Deadline();
}

LnsResult search_kernel(const ConflictGraph& graph, const IndependentSet& start, const LnsOptions& options,
                        const Deadline& deadline, const std::function<void(const LnsProgress&)>& report) {
  const Kernel kernel(graph, share_for_reductions(deadline));
  // The start loses where reductions decided otherwise, until the search has caught up.
  std::int64_t best = total_weight(start, graph);
  const auto report_whole = [&](const LnsProgress& now) {
    if (!report || now.weight + kernel.offset() <= best) return;
    best = now.weight + kernel.offset();
    report({now.iteration, best});
  };
  LnsResult result = Lns(kernel.graph(), kernel.project(start), options, deadline, report_whole).run();
  result.solution = kernel.lift(result.solution);
  result.weight = total_weight(result.solution, graph);
  return result;
}

}  // namespace

LnsResult improve_by_lns(const ConflictGraph& graph, const IndependentSet& initial, const LnsOptions& options,
                         const Deadline& deadline, const std::function<void(const LnsProgress&)>& report) {
  const Stopwatch watch;
  SolutionState state(graph, initial);
  state.make_maximal();
  const IndependentSet start = state.to_set();
  // The lift at the end costs as much as this: a quarter of a second at 33 million edges.
  const Deadline search_deadline = earlier(deadline, watch.seconds());
  const bool idle = options.iterations == 0 || deadline.passed();
  LnsResult result = options.reduce && !idle ? search_kernel(graph, start, options, search_deadline, report)
                                             : Lns(graph, start, options, search_deadline, report).run();
  if (result.weight < state.weight()) {
    result.solution = start;
    result.weight = state.weight();
  }
  return result;
}

}  // namespace hexpipe
