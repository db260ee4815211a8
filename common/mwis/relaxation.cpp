#include "common/mwis/relaxation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace hexpipe {
namespace {

// Prices are whole numbers of 2^-20 of a weight, or of more where sums would not fit.
constexpr int finest = 20;

std::int64_t round_down(std::int64_t value, int shift) {
  return value >> shift;
}

}  // namespace

Relaxation bounds_of_prices(const ConflictGraph& graph, const CliqueCover& cover, const std::vector<double>& prices) {
  const std::int64_t total = std::reduce(graph.weights.begin(), graph.weights.end(), std::int64_t{0});
  Relaxation result{.bound = total,
                    .with = std::vector<std::int64_t>(graph.weights.size(), total),
                    .without = std::vector<std::int64_t>(graph.weights.size(), total),
                    .fractions = {}};
  // Everything below stays under four times the total.
  const int shift = std::min(finest, 60 - static_cast<int>(std::bit_width(static_cast<std::uint64_t>(total))));
  const double sum = std::reduce(prices.begin(), prices.end(), 0.0);
  if (shift < 0 || !(sum <= static_cast<double>(total))) return result;

  std::vector<std::int64_t> costs(graph.weights.size());
  std::ranges::transform(graph.weights, costs.begin(), [&](std::int64_t weight) { return weight << shift; });
  std::int64_t bound = 0;
  for (std::size_t c = 0; c < prices.size(); ++c) {
    const std::int64_t price = std::llround(std::ldexp(prices[c], shift));
    bound += price;
    for (const std::int32_t v : cover.clique(static_cast<std::int64_t>(c))) costs[v] -= price;
  }
  for (const std::int64_t cost : costs) bound += std::max<std::int64_t>(0, cost);
  result.bound = round_down(bound, shift);
  for (std::size_t v = 0; v < costs.size(); ++v) {
    result.with[v] = round_down(bound + std::min<std::int64_t>(0, costs[v]), shift);
    result.without[v] = round_down(bound - std::max<std::int64_t>(0, costs[v]), shift);
  }
  return result;
}

}  // namespace hexpipe
