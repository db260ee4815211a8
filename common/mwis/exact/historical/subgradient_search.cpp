#include "common/mwis/exact/historical/subgradient_search.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace hexpipe::mwis::exact::historical {
namespace {

// Prices are whole multiples of 2^-20 of a weight, or of more if sums would not fit; sums stay below eight times the
// sum of all weights.
constexpr int finest = 20;
// Steps at the root and in a node; a node starts from its parent's prices.
constexpr int root_steps = 300, node_steps = 15;
// A step goes this share of the way that would bring the bound down to what is needed; the share shrinks each time.
constexpr double first_length = 1.0, shortening = 0.97;

}  // namespace

bool SubgradientSearch::solve(const ground::DenseGraph& graph, const graph::CliqueCover& cover,
                              std::int64_t lower_bound, ground::SearchBudget& budget) {
  begin(graph, lower_bound, budget);
  const std::int64_t total = std::reduce(graph.weights().begin(), graph.weights().end(), std::int64_t{0});
  shift_ = std::min(finest, 59 - static_cast<int>(std::bit_width(static_cast<std::uint64_t>(total))));
  assert(shift_ >= 0);
  costs_.assign(graph.size(), 0);
  chosen_.assign(static_cast<std::size_t>(cover.size()), 0);
  cliques_of_.assign(graph.size(), {});
  for (std::int64_t c = 0; c < cover.size(); ++c)
    for (const std::int32_t v : cover.clique(c)) cliques_of_[v].push_back(static_cast<std::int32_t>(c));
  expand(0, 0, Prices(static_cast<std::size_t>(cover.size()), 0));
  return found_;
}

// The candidates of this depth may be added to the current set, which weighs `weight`: first the branch with the
// candidate of highest reduced cost, then the branch without it, and so on.
void SubgradientSearch::expand(std::size_t depth, std::int64_t weight, Prices prices) {
  bits::Word* const candidates = row(depth, 0);
  offer(weight);
  while (budget_->spend()) {
    if (bits::empty(candidates, words_) || improve(depth, best_weight_ - weight, prices)) return;
    const std::size_t v = highest_cost(depth);
    bits::erase(candidates, v);
    enter(v, depth);
    expand(depth + 1, weight + graph_->weight(v), prices);
    leave();
  }
}

// Steps until the prices prove that no set of candidates is heavier than `needed` (then it returns true), or until
// there were enough steps, or no time is left. Leaves the best prices, and drops the candidates that they exclude.
bool SubgradientSearch::improve(std::size_t depth, std::int64_t needed, Prices& prices) {
  const std::int64_t target = needed << shift_;
  Prices now = prices;
  std::int64_t least = bound(depth, now);
  double length = first_length;
  for (int left = depth == 0 ? root_steps : node_steps;
       least >> shift_ > needed && left > 0 && budget_->look_at_clock(); --left) {
    const std::int64_t before = bound(depth, now);
    step(length * static_cast<double>(before - target), now);
    length *= shortening;
    const std::int64_t after = bound(depth, now);
    if (after > 2 * least) now = prices;  // too far
    if (after >= least) continue;
    least = after;
    prices = now;
  }
  if (least >> shift_ <= needed) return true;
  least = bound(depth, prices);
  bits::Word* const candidates = row(depth, 0);
  bits::for_each(candidates, words_, [&](std::size_t v) {
    if ((least + std::min<std::int64_t>(0, costs_[v])) >> shift_ <= needed) bits::erase(candidates, v);
  });
  return bits::empty(candidates, words_);
}

// Sets the costs, and counts the members of positive cost in each clique. A clique's price is paid only if it has a
// candidate.
std::int64_t SubgradientSearch::bound(std::size_t depth, const Prices& prices) {
  std::ranges::fill(chosen_, -1);
  std::int64_t sum = 0;
  bits::for_each(row(depth, 0), words_, [&](std::size_t v) {
    costs_[v] = graph_->weight(v) << shift_;
    for (const std::int32_t c : cliques_of_[v]) {
      costs_[v] -= prices[c];
      if (chosen_[c] < 0) {
        chosen_[c] = 0;
        sum += prices[c];
      }
    }
    if (costs_[v] <= 0) return;
    sum += costs_[v];
    for (const std::int32_t c : cliques_of_[v]) ++chosen_[c];
  });
  return sum;
}

// Steps against the subgradient at the last bound(): a clique that chooses more than 1 gets a higher price. `length` is
// the amount by which the bound would come down if it were linear.
void SubgradientSearch::step(double length, Prices& prices) {
  double square = 0;
  for (std::size_t c = 0; c < prices.size(); ++c)
    if (chosen_[c] > 1 || (chosen_[c] == 0 && prices[c] > 0)) square += (chosen_[c] - 1) * (chosen_[c] - 1);
  if (square == 0) return;
  for (std::size_t c = 0; c < prices.size(); ++c)
    if (chosen_[c] >= 0) {
      const std::int64_t change = std::llround(length * (chosen_[c] - 1) / square);
      prices[c] = std::max<std::int64_t>(0, prices[c] + change);
    }
}

std::size_t SubgradientSearch::highest_cost(std::size_t depth) {
  std::size_t best = costs_.size();
  bits::for_each(row(depth, 0), words_, [&](std::size_t v) {
    if (best == costs_.size() || costs_[v] > costs_[best]) best = v;
  });
  return best;
}

}  // namespace hexpipe::mwis::exact::historical
