#include "tools/assemble/choice/exchange_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::assemble::choice {
namespace {

// No participant may push out more. 4 gain 0.04 points of the share of hexes in the volume, in the mean of simp, blub
// and spot, in three times the time; 2 lose 0.05.
constexpr std::int32_t most_pushed_out = 3;
// The temperature stays the same for this many moves: computing it takes as long as a short move.
constexpr std::int64_t moves_a_temperature = 256;
// No change is as large as this.
constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::max();

}  // namespace

ExchangeSearch::ExchangeSearch(const ExchangeProblem& problem, const graph::IndependentSet& start, Random random)
    : problem_(problem),
      random_(random),
      is_chosen_(problem.stays.size(), 0),
      conflicts_(problem.stays.begin(), problem.stays.end()),
      rivals_(problem.stays.size(), 0) {
  cells_.reserve(problem.quads.size());
  for (const auto i : indices<Participant>(problem.quads.size())) {
    cells_.push_back({problem.graph.weights[i], problem.usual[i], problem.quads[i], unknown});
    if (!problem.stays[i]) movable_.push_back(i);
  }
  quads_.reserve(problem.cost.size());
  for (const auto quad : indices<QuadIndex>(problem.cost.size())) {
    quads_.push_back({problem.cost[quad], problem.fixed_cells[quad]});
    if (problem.fixed_cells[quad] == 1) open_cost_ += problem.cost[quad];
  }
  owners_ = VertexItemsOf<Participant>(quads_.size(), [&](auto&& visit) {
    for (const auto i : indices<Participant>(cells_.size()))
      for (const QuadIndex quad : cells_[i].quads)
        if (quad != no_index) visit(quad, i);
  });
  for (const auto participant : as_indices<Participant>(start)) count_in(participant), choose(participant);
  best_value_ = value();
}

void ExchangeSearch::run(std::int64_t moves, const mwis::local_search::Cooling& cooling) {
  if (movable_.empty()) return;
  double temperature = 0;
  for (std::int64_t i = 0; i < moves; ++i) {
    if (i % moves_a_temperature == 0) temperature = cooling.at(static_cast<double>(i) / static_cast<double>(moves));
    const Participant participant = movable_[random_.below(movable_.size())];
    if (conflicts_[participant] > most_pushed_out) continue;
    const double least_change = temperature * cells_[participant].usual * std::log(random_.uniform());
    if (static_cast<double>(change_of(participant)) >= least_change) carry_out(participant);
  }
}

std::int64_t ExchangeSearch::gain_of(Participant participant) const {
  const Cell& cell = cells_[participant];
  std::int64_t gain = cell.weight;
  for (const QuadIndex quad : cell.quads)
    if (quad != no_index) gain += quads_[quad].cells == 0 ? -quads_[quad].cost : quads_[quad].cost;
  return gain;
}

void ExchangeSearch::count_in(Participant participant) {
  const Cell& cell = cells_[participant];
  weight_ += cell.weight;
  for (const QuadIndex quad : cell.quads)
    if (quad != no_index) open_cost_ += ++quads_[quad].cells == 1 ? quads_[quad].cost : -quads_[quad].cost;
}

void ExchangeSearch::count_out(Participant participant) {
  const Cell& cell = cells_[participant];
  weight_ -= cell.weight;
  for (const QuadIndex quad : cell.quads)
    if (quad != no_index) open_cost_ += --quads_[quad].cells == 1 ? quads_[quad].cost : -quads_[quad].cost;
}

void ExchangeSearch::choose(Participant participant) {
  is_chosen_[participant] = 1;
  cells_[participant].change_without = unknown;
  count_conflicts(participant, 1);
}

void ExchangeSearch::leave(Participant participant) {
  is_chosen_[participant] = 0;
  count_conflicts(participant, -1);
}

void ExchangeSearch::count_conflicts(Participant participant, std::int32_t more) {
  for (const Participant u : neighbours_of(participant)) {
    if (conflicts_[u] == 1) forget_change_at(u);
    conflicts_[u] += more;
    rivals_[u] ^= participant;
    if (conflicts_[u] == 1) forget_change_at(u);
  }
}

// For a chosen participant, or for the only one that keeps this one out.
void ExchangeSearch::forget_change_at(Participant participant) {
  cells_[contains(participant) ? participant : Participant(rivals_[participant])].change_without = unknown;
}

void ExchangeSearch::forget_changes_at_quads(Participant participant) {
  for (const QuadIndex quad : cells_[participant].quads) {
    if (quad == no_index) continue;
    for (const Participant owner : owners_.at(quad))
      if (contains(owner) || conflicts_[owner] == 1) forget_change_at(owner);
  }
}

// What the value changes by if a move takes this one in or out. The change for a chosen one is kept: most moves meet
// these, and find all around as it was.
std::int64_t ExchangeSearch::change_of(Participant participant) {
  if (contains(participant) && cells_[participant].change_without != unknown) return cells_[participant].change_without;
  const std::int64_t before = value();
  plan(participant);
  const std::int64_t change = value() - before;
  drop_plan();
  if (contains(participant)) cells_[participant].change_without = change;
  return change;
}

// Fills out_ and in_, and counts quads and weight as they will be.
void ExchangeSearch::plan(Participant participant) {
  in_.clear();
  find_those_out(participant);
  find_freed();
  for (const Participant u : out_) count_out(u);
  if (!contains(participant)) take_in(participant);
  use_freed_room();
}

// A chosen participant goes out; another one pushes those in conflict with it out.
void ExchangeSearch::find_those_out(Participant participant) {
  out_.clear();
  if (contains(participant)) return out_.push_back(participant);
  std::int32_t left = conflicts_[participant];
  for (auto u = neighbours_of(participant).begin(); left > 0; ++u) {
    if (!contains(*u)) continue;
    out_.push_back(*u);
    --left;
  }
}

// Participants in conflict with those that go out, and with no others.
void ExchangeSearch::find_freed() {
  freed_.clear();
  if (out_.size() == 1) {
    for (const Participant u : neighbours_of(out_.front()))
      if (conflicts_[u] == 1) freed_.push_back(u);
    return;
  }
  for (const Participant out : out_)
    for (const Participant u : neighbours_of(out))
      if (--conflicts_[u] == 0) freed_.push_back(u);
  for (const Participant out : out_)
    for (const Participant u : neighbours_of(out)) ++conflicts_[u];
}

void ExchangeSearch::take_in(Participant participant) {
  count_in(participant);
  in_.push_back(participant);
  std::erase_if(freed_, [&](Participant u) { return u == participant || are_in_conflict(participant, u); });
}

void ExchangeSearch::use_freed_room() {
  while (true) {
    Participant best = no_index;
    std::int64_t most = 0;
    for (const Participant u : freed_)
      if (const std::int64_t gain = gain_of(u); gain > most) {
        most = gain;
        best = u;
      }
    if (best == no_index) return;
    take_in(best);
  }
}

void ExchangeSearch::drop_plan() {
  for (const Participant u : in_) count_out(u);
  for (const Participant u : out_) count_in(u);
}

void ExchangeSearch::carry_out(Participant participant) {
  plan(participant);
  for (const Participant u : out_) leave(u);
  for (const Participant u : in_) choose(u);
  for (const Participant u : out_) forget_changes_at_quads(u);
  for (const Participant u : in_) forget_changes_at_quads(u);
  keep();
}

void ExchangeSearch::keep() {
  if (value() > best_value_) {
    best_value_ = value();
    since_best_.clear();
    return;
  }
  since_best_.insert(since_best_.end(), out_.begin(), out_.end());
  since_best_.insert(since_best_.end(), in_.begin(), in_.end());
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
  IndexedVector<Participant, std::uint8_t> is_in_best = is_chosen_;
  for (const Participant participant : since_best_) is_in_best[participant] ^= 1;
  graph::IndependentSet set;
  for (const auto i : indices<Participant>(is_in_best.size()))
    if (is_in_best[i] != 0) set.push_back(i);
  return set;
}

bool ExchangeSearch::check() const {
  graph::IndependentSet chosen;
  for (const auto i : indices<Participant>(is_chosen_.size())) {
    if (!contains(i)) continue;
    if (std::ranges::any_of(chosen, [&](std::int32_t u) { return are_in_conflict(i, Participant(u)); })) return false;
    chosen.push_back(i);
  }
  ExchangeSearch fresh(problem_, chosen, random_);
  const auto is_known_change_right = [&](std::int32_t i) {
    const Participant participant(i);
    const std::int64_t known = cells_[participant].change_without;
    return known == unknown || known == fresh.change_of(participant);
  };
  return fresh.conflicts_ == conflicts_ && fresh.rivals_ == rivals_ && fresh.quads_ == quads_ &&
         fresh.value() == value() && std::ranges::all_of(chosen, is_known_change_right);
}

}  // namespace hexpipe::assemble::choice
