#include "common/mwis/bounds/clique_dual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/mwis/bounds/entropy_dual.hpp"

namespace hexpipe::mwis::bounds {
namespace {

class SmoothedDual {
 public:
  SmoothedDual(const graph::ConflictGraph& graph, const graph::CliqueCover& cover)
      : weights_(graph.weights),
        cover_(cover),
        prices_(static_cast<std::size_t>(cover.size()), 0.0),
        costs_(graph.weights.begin(), graph.weights.end()) {}

  // Steps through all prices, forth and back.
  void pass(double temperature) {
    for (std::int64_t c = 0; c < cover_.size(); ++c) step(c, temperature);
    for (std::int64_t c = cover_.size(); c-- > 0;) step(c, temperature);
  }

  // Adds cliques that the relaxed solution of the last pass violates; their price is 0.
  void add_cliques(const graph::ConflictGraph& graph, graph::CliqueCover& cover, double temperature) {
    std::vector<double> fractions(costs_.size());
    std::ranges::transform(costs_, fractions.begin(),
                           [&](double cost) { return std::min(1.0, std::exp(cost / temperature)); });
    graph::add_violated_cliques(graph, fractions, cover);
    prices_.resize(static_cast<std::size_t>(cover.size()), 0.0);
  }

  std::vector<std::int64_t> whole_prices() const {
    std::vector<std::int64_t> whole(prices_.size());
    for (std::int64_t c = 0; c < cover_.size(); ++c) whole[c] = whole_price(cover_.clique(c), prices_[c], weights_);
    return whole;
  }

 private:
  void step(std::int64_t c, double temperature) {
    prices_[c] = step_price(cover_.clique(c), prices_[c], temperature, costs_);
  }

  const std::vector<std::int64_t>& weights_;
  const graph::CliqueCover& cover_;
  std::vector<double> prices_, costs_;
};

// Passes in branch and reduce: before the first branch, and in a node.
constexpr std::int64_t root_passes = 900, node_passes = 60;

// The sum of all weights is at most this.
constexpr std::int64_t no_bound = std::numeric_limits<std::int64_t>::max();

// Counts passes or time, whichever has come further.
double progress(std::int64_t passes, const CliqueDualOptions& options, const Deadline& deadline) {
  const double of_passes = static_cast<double>(passes) / static_cast<double>(options.passes);
  const double of_time = deadline.elapsed() / (deadline.elapsed() + std::max(deadline.remaining(), 0.0));
  return dual_rounds(std::max(of_passes, of_time));
}

}  // namespace

std::vector<std::int64_t> reduced_costs(const graph::ConflictGraph& graph, const graph::CliqueCover& cover,
                                        const std::vector<std::int64_t>& prices) {
  std::vector<std::int64_t> costs = graph.weights;
  for (std::int64_t c = 0; c < cover.size(); ++c)
    for (const std::int32_t v : cover.clique(c)) costs[v] -= prices[c];
  return costs;
}

std::int64_t bound_of_prices(const graph::ConflictGraph& graph, const graph::CliqueCover& cover,
                             const std::vector<std::int64_t>& prices) {
  std::int64_t bound = 0;
  for (const std::int64_t price : prices)
    if (__builtin_add_overflow(bound, price, &bound)) return no_bound;
  // No cost is below minus the sum of the prices, and the costs above 0 sum up to at most the sum of the weights.
  std::int64_t left = 0;
  for (const std::int64_t cost : reduced_costs(graph, cover, prices)) left += std::max<std::int64_t>(0, cost);
  return __builtin_add_overflow(bound, left, &bound) ? no_bound : bound;
}

CliqueDual solve_clique_dual(const graph::ConflictGraph& graph, graph::CliqueCover& cover,
                             const CliqueDualOptions& options, const Deadline& deadline,
                             const std::function<void(const CliqueDual&)>& report) {
  CliqueDual best;
  best.prices.assign(static_cast<std::size_t>(cover.size()), 0);
  best.bound = bound_of_prices(graph, cover, best.prices);
  if (graph.vertex_count() == 0) return best;

  const auto heaviest = static_cast<double>(std::max<std::int64_t>(std::ranges::max(graph.weights), 1));
  SmoothedDual dual(graph, cover);
  double round = -1;
  while (best.passes < options.passes && best.bound > options.target && !deadline.passed()) {
    const double now = progress(best.passes, options, deadline);
    if (std::floor(now) > round && best.passes > 0) dual.add_cliques(graph, cover, heaviest * coldest_dual_temperature);
    round = std::floor(now);
    dual.pass(heaviest * dual_temperature(now));
    ++best.passes;
    std::vector<std::int64_t> prices = dual.whole_prices();
    const std::int64_t bound = bound_of_prices(graph, cover, prices);
    if (bound >= best.bound) continue;
    best.bound = bound;
    best.prices = std::move(prices);
    if (report) report(best);
  }
  best.prices.resize(static_cast<std::size_t>(cover.size()), 0);
  return best;
}

Relaxation relax_by_clique_dual(const graph::ConflictGraph& graph, std::int64_t target, int depth,
                                const Deadline& deadline) {
  graph::CliqueCover cover = graph::greedy_edge_clique_cover(graph);
  const CliqueDualOptions options{.passes = depth == 0 ? root_passes : node_passes, .target = target};
  const CliqueDual dual = solve_clique_dual(graph, cover, options, deadline);
  return bounds_of_prices(graph, cover, {dual.prices.begin(), dual.prices.end()});
}

}  // namespace hexpipe::mwis::bounds
