#include "common/mwis/bounds/entropy_dual.hpp"

#include <algorithm>
#include <cmath>

namespace hexpipe::mwis::bounds {
namespace {

// A third of the work goes into the cliques given at first. Its temperature falls geometrically from `hottest`, where
// all prices move at once, to the coldest, where few still do. Then cliques are added and all prices are warmed up
// again, ten times.
constexpr double hottest = 0.3, warmed_up = 0.02;
constexpr int rounds = 10;
constexpr double first_share = 1.0 / 3;

}  // namespace

double step_price(std::span<const std::int32_t> members, double price, double temperature, std::vector<double>& costs) {
  double highest = costs[members.front()];
  for (const std::int32_t v : members) highest = std::max(highest, costs[v]);
  double sum = 0;
  for (const std::int32_t v : members) sum += std::exp((costs[v] - highest) / temperature);
  const double wanted = highest + temperature * std::log(sum);
  const double change = std::max(wanted, -price);
  for (const std::int32_t v : members) costs[v] -= change;
  return price + change;
}

std::int64_t whole_price(std::span<const std::int32_t> members, double price, std::span<const std::int64_t> weights) {
  // Most prices are below the weight of some member, and the first members show it.
  std::int64_t heaviest = 0;
  for (const std::int32_t v : members) {
    heaviest = std::max(heaviest, weights[v]);
    if (price < static_cast<double>(heaviest)) return std::llround(price);
  }
  return heaviest;
}

double dual_rounds(double done) {
  const double over = done - first_share;
  return over < 0 ? over / first_share : over / (1 - first_share) * rounds;
}

double dual_temperature(double at) {
  const double first = at < 0 ? hottest : warmed_up;
  return first * std::pow(coldest_dual_temperature / first, at - std::floor(at));
}

}  // namespace hexpipe::mwis::bounds
