#pragma once
// The weight at which a search may stop because of a known bound.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace hexpipe::mwis::ground {

// The lowest bound that certify has proven for this graph, according to the history of a bundle. Bounds from before the
// graph was made or read from a file do not count.
std::optional<std::int64_t> bound_in(const std::vector<nlohmann::ordered_json>& history);

// The weight that initsol or lns has proven to be the best for this graph, according to the history. It holds for as
// long as only tools follow that leave the graph as it is.
std::optional<std::int64_t> optimum_in(const std::vector<nlohmann::ordered_json>& history);

// How far a weight is from a bound, as a share of the bound; 0 if the bound is 0.
double gap_to(std::int64_t bound, std::int64_t weight);

// The least weight whose gap to the bound is at most `gap`. `constant` is in weights and bounds, but not in the gap:
// what vertices of quads weigh. Throws DataError when no bound is known.
std::int64_t target_weight(double gap, std::optional<std::int64_t> bound, std::int64_t constant = 0);

}  // namespace hexpipe::mwis::ground
