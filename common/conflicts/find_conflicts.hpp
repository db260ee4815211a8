#pragma once
// Finds the conflict graph of candidates, and weighs them: docs/definitions.md 2.

#include <cstdint>
#include <vector>

#include "common/graph/conflict_graph.hpp"
#include "common/mesh/candidates.hpp"
#include "common/run/share.hpp"

namespace hexpipe::conflicts {

// How the weight of a candidate, an integer, is computed.
enum class WeightKind { quality, volume, count, quality_volume, mild_quality_volume };

// The power of the quality in mild_quality_volume. assemble's exchange of hexes weighs them in the same way: 0.2 loses
// 0.08 points of the volume and hexes are worse; 0.5 loses 0.07 and hexes are better.
inline constexpr double mild_power_of_quality = 0.3;

// Returns round(scale * w), at least 0. Throws DataError naming `source` when a quality or volume is negative, or the
// sum does not fit 64 bits.
std::vector<std::int64_t> weights_of(const Candidates& candidates, WeightKind kind, double scale, const char* source);

struct ConflictOptions {
  WeightKind weight = WeightKind::quality;
  double weight_scale = 1e6;
  Share share{};  // only conflicts whose higher end is in this share of the candidates
};

// Vertex i is candidate i. Candidates that are moved in are freed before the graph takes its memory. If `own` is not
// empty, conflicts between two candidates that are not own are left out. Throws DataError naming `source` when weights
// do not fit (see weights_of) or there are 2^31 candidates or more.
graph::ConflictGraph conflict_graph(Candidates candidates, const ConflictOptions& options, const char* source,
                                    const std::vector<bool>& own = {});

}  // namespace hexpipe::conflicts
