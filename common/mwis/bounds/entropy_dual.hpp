#pragma once
// Coordinate steps of the clique dual, smoothed by entropy (Haller and Savchynskyy 2024), and their temperatures.

#include <cstdint>
#include <span>
#include <vector>

namespace hexpipe::mwis::bounds {

// Minimizes sum(prices) + T sum(exp(cost / T)) over the price of one clique. Returns that price and updates the
// members' costs. After the step the members sum to one, if exp(cost / T) says how much of a vertex is chosen.
double step_price(std::span<const std::int32_t> members, double price, double temperature, std::vector<double>& costs);

// Rounds a price, and lowers it to the weight of the heaviest member: a higher price proves nothing more. If the
// temperatures are those of one heavy vertex, prices of light cliques are far above it.
std::int64_t whole_price(std::span<const std::int32_t> members, double price, std::span<const std::int64_t> weights);

// The passes are a first stretch and then rounds; cliques are added before each round. Returns how far the search is,
// in rounds (below 0 during the first stretch), given the share `done` from 0 to 1.
double dual_rounds(double done);
// In units of the heaviest weight.
double dual_temperature(double rounds);
// The temperature at the end of each round, where the relaxed solution is clearest.
inline constexpr double coldest_dual_temperature = 0.0015;

}  // namespace hexpipe::mwis::bounds
