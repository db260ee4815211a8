#include "common/conflicts/find_conflicts.hpp"

#include <cmath>

#include "common/run/error.hpp"

namespace hexpipe::conflicts {
namespace {

double worth(const Candidates& candidates, std::size_t i, WeightKind kind) {
  switch (kind) {
    case WeightKind::quality:
      return candidates.quality[i];
    case WeightKind::volume:
      return candidates.volume[i];
    case WeightKind::quality_volume:
      return candidates.quality[i] * candidates.volume[i];
    case WeightKind::mild_quality_volume:
      return std::pow(candidates.quality[i], mild_power_of_quality) * candidates.volume[i];
    case WeightKind::count:
      break;
  }
  return 1;
}

}  // namespace

std::vector<std::int64_t> weights_of(const Candidates& candidates, WeightKind kind, double scale, const char* source) {
  constexpr double too_large = 0x1p63;
  std::vector<std::int64_t> weights(candidates.size());
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double unscaled = worth(candidates, i, kind);
    if (unscaled < 0)
      throw DataError::at(source, "expected no negative weight, found {} for candidate {}", unscaled, i + 1);
    const double weight = scale * unscaled;
    if (!(weight < too_large) || __builtin_add_overflow(sum, weights[i] = std::llround(weight), &sum))
      throw DataError::at(source,
                          "expected weights whose sum fits 64 bits, found too large ones up to candidate {}: "
                          "a smaller --weight-scale helps",
                          i + 1);
  }
  return weights;
}

}  // namespace hexpipe::conflicts
