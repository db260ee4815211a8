#include "common/mwis/bounds/relaxation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace hexpipe::mwis::bounds {
namespace {

// Prices are whole multiples of 2^-20 of a weight, or of more if sums would not fit.
constexpr int finest = 20;
// Sums of prices and costs stay below four times the sum of all weights; they fit 64 bits if that sum has at most this
// many bits.
constexpr int most_bits = 60;

__extension__ using Wide = __int128;

// Computes in whole multiples of 2^-shift of a weight; `Sum` has room for them. No set is heavier than all vertices
// together.
template <class Sum>
void bring_down(const graph::ConflictGraph& graph, const graph::CliqueCover& cover, const std::vector<double>& prices,
                int shift, Relaxation& result) {
  const std::int64_t total = result.bound;
  const auto round_down = [&](Sum value) { return static_cast<std::int64_t>(std::min<Sum>(value >> shift, total)); };
  std::vector<Sum> costs(graph.weights.size());
  std::ranges::transform(graph.weights, costs.begin(), [&](std::int64_t weight) { return Sum{weight} << shift; });
  Sum bound = 0;
  for (std::size_t c = 0; c < prices.size(); ++c) {
    const auto price = static_cast<Sum>(std::round(std::ldexp(prices[c], shift)));
    bound += price;
    for (const std::int32_t v : cover.clique(static_cast<std::int64_t>(c))) costs[v] -= price;
  }
  for (const Sum cost : costs) bound += std::max<Sum>(0, cost);
  result.bound = round_down(bound);
  for (std::size_t v = 0; v < costs.size(); ++v) {
    result.with[v] = round_down(bound + std::min<Sum>(0, costs[v]));
    result.without[v] = round_down(bound - std::max<Sum>(0, costs[v]));
  }
}

}  // namespace

Relaxation bounds_of_prices(const graph::ConflictGraph& graph, const graph::CliqueCover& cover,
                            const std::vector<double>& prices) {
  const std::int64_t total = std::reduce(graph.weights.begin(), graph.weights.end(), std::int64_t{0});
  Relaxation result{.bound = total,
                    .with = std::vector<std::int64_t>(graph.weights.size(), total),
                    .without = std::vector<std::int64_t>(graph.weights.size(), total),
                    .fractions = {}};
  const double sum = std::reduce(prices.begin(), prices.end(), 0.0);
  if (!(sum <= static_cast<double>(total))) return result;
  const int spare = most_bits - static_cast<int>(std::bit_width(static_cast<std::uint64_t>(total)));
  if (spare < 0)
    bring_down<Wide>(graph, cover, prices, finest, result);
  else
    bring_down<std::int64_t>(graph, cover, prices, std::min(finest, spare), result);
  return result;
}

}  // namespace hexpipe::mwis::bounds
