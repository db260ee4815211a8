#include "common/mwis/local_search/push_walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hexpipe::mwis::local_search {
namespace {

constexpr std::int64_t trials_a_look_at_the_clock = 1 << 13;
// Metropolis' rule needs logarithms of random numbers. These of evenly spaced numbers are near enough: a loss of more
// than 9 times the temperature is never accepted.
constexpr std::uint64_t levels = 4096;

const std::array<double, levels>& logarithms() {
  static const std::array<double, levels> table = [] {
    std::array<double, levels> values{};
    for (std::size_t i = 0; i < levels; ++i) values[i] = std::log((static_cast<double>(i) + 0.5) / levels);
    return values;
  }();
  return table;
}

}  // namespace

PushWalk::PushWalk(const graph::ConflictGraph& graph, const graph::IndependentSet& start, Random random)
    : random_(random), state_(graph, start), best_weight_(0) {
  state_.make_maximal();
  best_weight_ = state_.weight();
}

std::int64_t PushWalk::run(std::int64_t trials, double temperature, const Deadline& deadline) {
  const auto vertices = static_cast<std::uint64_t>(state_.graph().vertex_count());
  const std::array<double, levels>& logs = logarithms();
  std::int64_t heaviest = state_.weight();
  if (vertices == 0) return heaviest;
  for (std::int64_t i = 0; i < trials; ++i) {
    if (i % trials_a_look_at_the_clock == 0 && deadline.passed()) break;
    ++trials_;
    // One draw gives both the vertex and the level.
    const std::uint64_t draw = random_.next();
    const auto v = static_cast<std::int32_t>((draw >> 32) * vertices >> 32);
    if (state_.contains(v)) continue;
    if (static_cast<double>(state_.push_gain(v)) <= temperature * logs[draw % levels]) continue;
    push(v);
    heaviest = std::max(heaviest, state_.weight());
  }
  return heaviest;
}

void PushWalk::push(std::int32_t v) {
  if (is_at_best_ && state_.push_gain(v) < 0) {
    best_ = state_.to_set();
    is_at_best_ = false;
  }
  pushed_out_.clear();
  state_.for_each_chosen_neighbour(v, [&](std::int32_t u) { pushed_out_.push_back(u); });
  for (const std::int32_t u : pushed_out_) {
    touched_ += state_.graph().degree(u);
    state_.remove(u);
  }
  touched_ += state_.graph().degree(v);
  state_.add(v);
  if (state_.weight() <= best_weight_) return;
  best_weight_ = state_.weight();
  is_at_best_ = true;
}

}  // namespace hexpipe::mwis::local_search
