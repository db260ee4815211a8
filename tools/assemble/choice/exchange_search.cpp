#include "tools/assemble/choice/exchange_search.hpp"

#include <algorithm>
#include <cmath>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::assemble::choice {
namespace {

// No participant may push out more. 4 gain 0.04 points of the share of hexes in the volume, in the mean of simp, blub
// and spot, in three times the time; 2 lose 0.05.
constexpr std::int32_t most_pushed_out = 3;
// The temperature stays the same for this many moves: computing it takes as long as a short move.
constexpr std::int64_t moves_a_temperature = 256;

}  // namespace

ExchangeSearch::ExchangeSearch(const ExchangeProblem& problem, const graph::IndependentSet& start, Random random)
    : problem_(problem), state_(problem.graph), random_(random), cells_at_(problem.fixed_cells) {
  for (const auto quad : indices<QuadIndex>(cells_at_.size()))
    if (cells_at_[quad] == 1) open_cost_ += problem.cost[quad];
  for (const auto participant : as_indices<Participant>(start)) enter(participant);
  for (const auto i : indices<Participant>(problem.stays.size()))
    if (!problem.stays[i]) movable_.push_back(i);
  best_value_ = value();
}

void ExchangeSearch::run(std::int64_t moves, const mwis::local_search::Cooling& cooling) {
  if (movable_.empty()) return;
  double temperature = 0;
  for (std::int64_t i = 0; i < moves; ++i) {
    if (i % moves_a_temperature == 0) temperature = cooling.at(static_cast<double>(i) / static_cast<double>(moves));
    const Participant participant = movable_[random_.below(movable_.size())];
    if (state_.tightness(participant) > most_pushed_out) continue;
    move(participant, temperature * problem_.usual[participant] * std::log(random_.uniform()));
  }
}

void ExchangeSearch::move(Participant participant, double least_change) {
  const std::int64_t before = value();
  step_.clear();
  freed_.clear();
  if (state_.contains(participant))
    remove(participant);
  else
    push(participant);
  use_freed_room();
  if (static_cast<double>(value() - before) >= least_change)
    keep();
  else
    take_back();
}

void ExchangeSearch::push(Participant participant) {
  pushed_out_.clear();
  state_.for_each_chosen_neighbour(participant, [&](std::int32_t u) { pushed_out_.emplace_back(u); });
  for (const Participant u : pushed_out_) remove(u);
  add(participant);
}

void ExchangeSearch::use_freed_room() {
  while (true) {
    std::erase_if(freed_, [&](Participant u) { return state_.contains(u) || state_.tightness(u) > 0; });
    Participant best = no_index;
    std::int64_t most = 0;
    for (const Participant u : freed_)
      if (const std::int64_t gain = gain_of(u); gain > most) {
        most = gain;
        best = u;
      }
    if (best == no_index) return;
    add(best);
  }
}

std::int64_t ExchangeSearch::gain_of(Participant participant) const {
  std::int64_t gain = problem_.graph.weights[participant];
  for (const QuadIndex quad : problem_.quads[participant])
    if (quad != no_index) gain += cells_at_[quad] == 0 ? -problem_.cost[quad] : problem_.cost[quad];
  return gain;
}

void ExchangeSearch::enter(Participant participant) {
  state_.add(participant);
  for (const QuadIndex quad : problem_.quads[participant])
    if (quad != no_index) open_cost_ += ++cells_at_[quad] == 1 ? problem_.cost[quad] : -problem_.cost[quad];
}

void ExchangeSearch::add(Participant participant) {
  enter(participant);
  step_.push_back(participant);
}

void ExchangeSearch::remove(Participant participant) {
  state_.remove(participant, [&](std::int32_t u) {
    if (state_.tightness(u) == 0 && !problem_.stays[Participant(u)]) freed_.emplace_back(u);
  });
  for (const QuadIndex quad : problem_.quads[participant])
    if (quad != no_index) open_cost_ += --cells_at_[quad] == 1 ? problem_.cost[quad] : -problem_.cost[quad];
  step_.push_back(participant);
}

void ExchangeSearch::take_back() {
  for (std::size_t i = step_.size(); i-- > 0;) {
    const Participant participant = step_[i];
    if (state_.contains(participant))
      remove(participant);
    else
      enter(participant);
  }
}

void ExchangeSearch::keep() {
  if (value() > best_value_) {
    best_value_ = value();
    since_best_.clear();
    return;
  }
  since_best_.insert(since_best_.end(), step_.begin(), step_.end());
  if (since_best_.size() > 2 * movable_.size() + 64) forget_what_came_back();
}

// A participant that went in and out again is where it was: it is enough to list each at most once.
void ExchangeSearch::forget_what_came_back() {
  std::ranges::sort(since_best_);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < since_best_.size();) {
    if (i + 1 < since_best_.size() && since_best_[i] == since_best_[i + 1]) {
      i += 2;
    } else {
      since_best_[kept++] = since_best_[i++];
    }
  }
  since_best_.resize(kept);
}

graph::IndependentSet ExchangeSearch::best() const {
  IndexedVector<Participant, std::uint8_t> toggled(problem_.stays.size(), 0);
  for (const Participant participant : since_best_) toggled[participant] ^= 1;
  graph::IndependentSet set;
  for (const auto i : indices<Participant>(toggled.size()))
    if (state_.contains(i) != (toggled[i] != 0)) set.push_back(i);
  return set;
}

bool ExchangeSearch::check() const {
  const ExchangeSearch fresh(problem_, state_.to_set(), random_);
  return state_.check() && fresh.cells_at_ == cells_at_ && fresh.open_cost_ == open_cost_;
}

}  // namespace hexpipe::assemble::choice
