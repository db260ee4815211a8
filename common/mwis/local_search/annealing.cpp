#include "common/mwis/local_search/annealing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace hexpipe::mwis::local_search {
namespace {

// If a graph fits in no cache, kicks go to random vertices of a window that moves over all of them, because most
// neighbours have numbers near each other. A million vertices then take a third of the time. random-33k needs no window
// and would lose 0.4 % by one.
constexpr std::int64_t least_for_windows = 1 << 18;
constexpr std::int64_t window = 4096;
constexpr std::int64_t kicks_a_window = 512;

}  // namespace

double Cooling::at(double progress) const {
  return hot * std::pow(cold / hot, progress);
}

// At a temperature T, a solution of `chosen` vertices is lighter than the best by about chosen * T^2, and varies by T *
// sqrt(chosen * T). So it reaches the best by itself up to a T proportional to 1 / chosen; lower temperatures only take
// time. A large graph needs all its vertices right at once, so it must be cold in the end. Measured: C2000.9 (69
// chosen) reaches 10,928 in 2 s from 1 to 0.3, but 10,614 from 0.3 to 0.1; 1dc.2048 (172 chosen) reaches its optimum of
// 172, but 143 when it starts at 0.3; frb59-26-5 (59 chosen) reaches 6,558 from 1.5 to 0.5, but 6,497 when it starts at
// 0.3. Graphs of 1,400 and 1,900 chosen lose up to 3 % when hotter.
Cooling Cooling::for_chosen(std::int64_t chosen) {
  constexpr double chosen_at_once = 25, coldest_of_few = 0.3;
  const Cooling of_many;
  const double cold =
      std::clamp(chosen_at_once / static_cast<double>(std::max<std::int64_t>(chosen, 1)), of_many.cold, coldest_of_few);
  return {.hot = of_many.hot * std::sqrt(cold / of_many.cold), .cold = cold};
}

Annealing::Annealing(const graph::ConflictGraph& graph, const graph::IndependentSet& start, Random random,
                     const Deadline& deadline)
    : random_(random), state_(graph, start), is_waiting_(graph.weights.size(), 0), marks_(graph.weights.size(), 0) {
  state_.make_maximal();
  for (std::int32_t v = 0; v < graph.vertex_count(); ++v) wait(v);
  settle_first(deadline);
  step_.clear();
  best_weight_ = state_.weight();
}

void Annealing::run(std::int64_t kicks, double temperature, const Deadline& deadline, std::int64_t most_touched) {
  if (state_.graph().vertex_count() == 0) return;
  const std::int64_t touched_before = touched_;
  for (std::int64_t i = 0; i < kicks && touched_ - touched_before < most_touched; ++i) {
    if (i % 64 == 0 && deadline.passed()) return;
    ++kicks_;
    const std::int64_t before = state_.weight();
    step_.clear();
    kick(next_to_kick());
    settle();
    const auto change = static_cast<double>(state_.weight() - before);
    if (change >= 0 || change > temperature * std::log(random_.uniform()))
      keep();
    else
      take_back();
  }
}

std::int32_t Annealing::next_to_kick() {
  const std::int64_t vertices = state_.graph().vertex_count();
  if (vertices < least_for_windows)
    return static_cast<std::int32_t>(random_.below(static_cast<std::uint64_t>(vertices)));
  if (kicks_ % kicks_a_window == 0) window_begin_ = (window_begin_ + window) % vertices;
  const auto place = static_cast<std::int64_t>(random_.below(window));
  return static_cast<std::int32_t>((window_begin_ + place) % vertices);
}

void Annealing::kick(std::int32_t v) {
  if (state_.contains(v))
    remove(v);
  else
    push(v);
}

// Works in rounds, each in random order. The vertices that a change touches are looked at in the next round.
void Annealing::settle() {
  while (!waiting_.empty()) {
    begin_round();
    for (const std::int32_t v : settling_) settle(v);
  }
}

// On a graph with a hundred million edges, settling the whole graph takes seconds.
void Annealing::settle_first(const Deadline& deadline) {
  while (!waiting_.empty()) {
    begin_round();
    for (const std::int32_t v : settling_) {
      if (deadline.passed()) break;
      settle(v);
    }
    if (!deadline.passed()) continue;
    for (const std::int32_t v : waiting_) is_waiting_[v] = 0;
    waiting_.clear();
  }
}

void Annealing::begin_round() {
  random_.shuffle(std::span(waiting_));
  std::swap(waiting_, settling_);
  waiting_.clear();
  for (const std::int32_t v : settling_) is_waiting_[v] = 0;
}

void Annealing::settle(std::int32_t v) {
  if (state_.contains(v))
    swap_for_two(v);
  else if (state_.push_gain(v) > 0)
    push(v);
}

void Annealing::push(std::int32_t v) {
  pushed_out_.clear();
  state_.for_each_chosen_neighbour(v, [&](std::int32_t u) { pushed_out_.push_back(u); });
  for (const std::int32_t u : pushed_out_) remove(u);
  add(v);
}

// Makes the best swap of v for two of the vertices that only v keeps out. False if no swap gains.
bool Annealing::swap_for_two(std::int32_t v) {
  const graph::ConflictGraph& graph = state_.graph();
  loose_.clear();
  std::int64_t heaviest = 0;
  for (const std::int32_t u : graph.neighbours_of(v)) {
    if (state_.tightness(u) != 1) continue;
    loose_.push_back(u);
    heaviest = std::max(heaviest, graph.weights[u]);
  }
  std::int64_t best_sum = graph.weights[v];
  std::int32_t first = no_index, second = no_index;
  for (std::size_t i = 0; i < loose_.size(); ++i) {
    const std::int32_t a = loose_[i];
    const std::int64_t weight = graph.weights[a];
    if (heaviest <= best_sum - weight) continue;
    if (++stamp_ == 0) std::ranges::fill(marks_, 0), stamp_ = 1;
    for (const std::int32_t u : graph.neighbours_of(a)) marks_[u] = stamp_;
    for (std::size_t j = i + 1; j < loose_.size(); ++j) {
      const std::int32_t b = loose_[j];
      if (graph.weights[b] <= best_sum - weight || marks_[b] == stamp_) continue;
      best_sum = weight + graph.weights[b];
      first = a, second = b;
    }
  }
  if (first == no_index) return false;
  remove(v);
  add(first);
  add(second);
  return true;
}

void Annealing::add(std::int32_t v) {
  count(v);
  state_.add(v);
  step_.push_back(v);
  wait(v);
}

void Annealing::remove(std::int32_t v) {
  count(v);
  state_.remove(v, [&](std::int32_t u) {
    if (state_.push_gain(u) > 0)
      wait(u);
    else if (state_.tightness(u) == 1)  // swapping the one that keeps it out may gain now
      wait(static_cast<std::int32_t>(state_.neighbour_sum(u)));
  });
  step_.push_back(v);
  wait(v);
}

void Annealing::wait(std::int32_t v) {
  if (is_waiting_[v]) return;
  is_waiting_[v] = 1;
  waiting_.push_back(v);
}

void Annealing::take_back() {
  for (std::size_t i = step_.size(); i-- > 0;) {
    const std::int32_t v = step_[i];
    count(v);
    if (state_.contains(v))
      state_.remove(v);
    else
      state_.add(v);
  }
}

void Annealing::keep() {
  if (state_.weight() > best_weight_) {
    best_weight_ = state_.weight();
    best_is_stored_ = false;
    since_best_.clear();
    return;
  }
  if (best_is_stored_) return;
  since_best_.insert(since_best_.end(), step_.begin(), step_.end());
  if (since_best_.size() < static_cast<std::size_t>(state_.graph().vertex_count())) return;
  best_ = present_without(since_best_);
  best_is_stored_ = true;
  since_best_.clear();
}

graph::IndependentSet Annealing::best() const {
  return best_is_stored_ ? best_ : present_without(since_best_);
}

graph::IndependentSet Annealing::present_without(const std::vector<std::int32_t>& toggles) const {
  std::vector<std::uint8_t> toggled(is_waiting_.size(), 0);
  for (const std::int32_t v : toggles) toggled[v] ^= 1;
  graph::IndependentSet set;
  for (std::int32_t v = 0; v < state_.graph().vertex_count(); ++v)
    if (state_.contains(v) != (toggled[v] != 0)) set.push_back(v);
  return set;
}

std::int64_t Annealing::chosen_count() const {
  std::int64_t chosen = 0;
  for (std::int32_t v = 0; v < state_.graph().vertex_count(); ++v) chosen += state_.contains(v) ? 1 : 0;
  return chosen;
}

double Annealing::mean_weight() const {
  return state_.weight() > 0 ? static_cast<double>(state_.weight()) / static_cast<double>(chosen_count()) : 1;
}

bool Annealing::check() const {
  if (!state_.check() || !waiting_.empty()) return false;
  for (std::int32_t v = 0; v < state_.graph().vertex_count(); ++v)
    if (!state_.contains(v) && state_.push_gain(v) > 0) return false;
  return true;
}

}  // namespace hexpipe::mwis::local_search
