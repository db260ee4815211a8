#pragma once
// Coordinate steps of the clique dual smoothed by entropy (Haller and Savchynskyy 2024), and their temperatures.

#include <cstdint>
#include <span>
#include <vector>

namespace hexpipe::mwis::bounds {

// Minimizes sum(prices) + T sum(exp(cost / T)) in the price of one clique, which it returns; the members' costs follow.
// The step makes the members sum to one where exp(cost / T) is how much of a vertex is chosen.
double step_price(std::span<const std::int32_t> members, double price, double temperature, std::vector<double>& costs);

// A price to the next whole number, and no more than the heaviest member of the clique weighs: beyond that it pays for
// nothing. Where temperatures are those of one heavy vertex, prices of light cliques are far above it.
std::int64_t whole_price(std::span<const std::int32_t> members, double price, std::span<const std::int64_t> weights);

// The passes are cut into a first stretch and rounds, before each of which cliques are added. How far the search is, in
// rounds: below 0 before the first; `done` from 0 to 1.
double dual_rounds(double done);
// In heaviest weights.
double dual_temperature(double rounds);
// That of the end of each round, where the relaxed solution is at its clearest.
inline constexpr double coldest_dual_temperature = 0.0015;

}  // namespace hexpipe::mwis::bounds
