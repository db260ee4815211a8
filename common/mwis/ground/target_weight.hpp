#pragma once
// The weight at which a search may stop, from a bound that is known.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace hexpipe::mwis::ground {

// The lowest bound that certify has proven since the graph was made or came from a file, by the history of a bundle.
std::optional<std::int64_t> bound_in(const std::vector<nlohmann::ordered_json>& history);

// How far a weight is from a bound, as a share of the bound; 0 where the bound is.
double gap_to(std::int64_t bound, std::int64_t weight);

// The least weight whose gap to the bound is no more than this. Throws DataError when no bound is known.
std::int64_t target_weight(double gap, std::optional<std::int64_t> bound);

}  // namespace hexpipe::mwis::ground
