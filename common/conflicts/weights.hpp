#pragma once
// The weight of a candidate, as an integer.

#include <cstdint>
#include <vector>

#include "common/mesh/candidates.hpp"

namespace hexpipe::conflicts {

enum class WeightKind { quality, volume, count, quality_volume };

// Returns round(scale * w), at least 0. Throws DataError naming `source` when a quality or volume is negative, or the
// sum does not fit 64 bits.
std::vector<std::int64_t> weights_of(const Candidates& candidates, WeightKind kind, double scale, const char* source);

}  // namespace hexpipe::conflicts
