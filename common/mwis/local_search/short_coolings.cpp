#include "common/mwis/local_search/short_coolings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hexpipe::mwis::local_search {
namespace {

// Large graphs of the pipeline have sparser conflicts and more chosen vertices. Every one of their regions has to be
// right at once, which kicks do better: on random-33k a walk over pushes ends 3 % lower (docs/log/mwis.md). Smaller
// ones are solved exactly.
constexpr std::int64_t most_chosen = 250, least_vertices = 100;
constexpr std::int64_t least_edges_share = 50;  // a vertex is in conflict with one in so many of the others at least

// On C2000.9, where the best are found between 0.2 and 0.25 mean weights of a chosen vertex, on frb59-26-5 (0.13 to
// 0.15) and on 1dc.2048 (0.15 to 0.3) the first range covers all; later ones are as narrow as still melts what the one
// before froze. Of 1.2, 1.35 and 1.5, 1.2 stays in one basin on 1dc.2048, and 1.5 takes half of the time for heat.
constexpr double first_hot = 0.4, first_cold = 0.08, spread = 1.35;
constexpr double share_of_last = 0.2;  // in the usual temperature
// Of the shortest cooling. 2000 and 4000 find more on frb59-26-5 in 5 s, but less on all graphs in a second. So they
// grow: by as much again after this many coolings.
constexpr std::int64_t trials_a_vertex = 1000;
constexpr std::int64_t coolings_to_grow = 32;
constexpr std::int64_t steps_a_cooling = 50;
// The tabu search gets so many times the work of the walk, in turns of a tenth of a millisecond. It finds the best
// known set of C2000.9 five times as often, and as good ones on frb59-26-5; on auctions (in608) the walk finds better
// ones.
constexpr double tabu_to_walk = 2;
constexpr std::int64_t trials_a_turn = 1 << 13;

}  // namespace

bool ShortCoolings::suit(const graph::ConflictGraph& graph, std::int64_t chosen) {
  const std::int64_t vertices = graph.vertex_count();
  return vertices >= least_vertices && chosen <= most_chosen &&
         least_edges_share * std::ssize(graph.neighbours) >= vertices * vertices;
}

ShortCoolings::ShortCoolings(const graph::ConflictGraph& graph, const graph::IndependentSet& start, Random random)
    : walk_(graph, start, random), trials_a_unit_(trials_a_vertex * std::max(1, graph.vertex_count())) {
  const std::size_t chosen = walk_.best().size();
  const double mean =
      walk_.best_weight() > 0 ? static_cast<double>(walk_.best_weight()) / static_cast<double>(chosen) : 1;
  hot_ = first_hot * mean;
  cold_ = first_cold * mean;
  usual_temperature_ = std::sqrt(hot_ * cold_);
  if (PushGains::suit(graph)) tabu_.emplace(graph, Random(random.next()));
}

void ShortCoolings::run(double touched, const Deadline& deadline) {
  granted_ += touched;
  while (this->touched() < granted_ && !deadline.passed()) {
    cool(trials_a_turn, deadline);
    if (tabu_) tabu_->run(std::numeric_limits<std::int64_t>::max(), deadline, tabu_to_walk * touched_by_walk());
  }
}

void ShortCoolings::cool(std::int64_t trials, const Deadline& deadline) {
  while (trials > 0 && !deadline.passed()) {
    if (done_ == trials_) begin_cooling();
    const std::int64_t step = std::max<std::int64_t>(1, trials_ / steps_a_cooling);
    const std::int64_t now = std::min({trials, step - done_ % step, trials_ - done_});
    const double at = temperature();
    const std::int64_t heaviest = walk_.run(now, at, deadline);
    if (heaviest > heaviest_) {
      heaviest_ = heaviest;
      temperature_of_heaviest_ = at;
    }
    done_ += now;
    trials -= now;
    if (done_ == trials_) end_cooling();
  }
}

void ShortCoolings::begin_cooling() {
  ++coolings_;
  trials_ = luby(coolings_) * (trials_a_unit_ + trials_a_unit_ * coolings_ / coolings_to_grow);
  done_ = 0;
  heaviest_ = 0;
  if (coolings_ == 1) return;
  hot_ = usual_temperature_ * spread;
  cold_ = usual_temperature_ / spread;
}

// A cooling that does not beat the set it began with counts as hot: it makes the next one hotter.
void ShortCoolings::end_cooling() {
  const double share = coolings_ == 1 ? 1 : share_of_last;
  if (heaviest_ > 0) usual_temperature_ *= std::pow(temperature_of_heaviest_ / usual_temperature_, share);
}

double ShortCoolings::temperature() const {
  const std::int64_t step = std::max<std::int64_t>(1, trials_ / steps_a_cooling);
  const double progress = static_cast<double>(done_ / step) / static_cast<double>(steps_a_cooling);
  return hot_ * std::pow(cold_ / hot_, std::min(1.0, progress));
}

double ShortCoolings::touched() const {
  return touched_by_walk() + (tabu_ ? tabu_->touched() : 0);
}

double ShortCoolings::touched_by_walk() const {
  constexpr double touched_a_trial = 1.5;
  return static_cast<double>(walk_.touched()) + touched_a_trial * static_cast<double>(walk_.trials());
}

}  // namespace hexpipe::mwis::local_search
