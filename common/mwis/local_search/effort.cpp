#include "common/mwis/local_search/effort.hpp"

#include <algorithm>
#include <cmath>

namespace hexpipe::mwis::local_search {
namespace {

// Gains made before this many nanoseconds of work with the same operator count a third.
constexpr double memory = 3e8;
// The share that each operator keeps at least, because its gains may come later.
constexpr std::array least_shares{0.2, 0.2, 0.1};

double least_share_of(Way way) {
  return least_shares[static_cast<std::size_t>(way)];
}

}  // namespace

Way Effort::next() const {
  return *std::ranges::max_element(ways_, {}, [this](Way way) { return of(way).credit - of(way).cost; });
}

double Effort::share_of(Way way) const {
  double yields = 0, left = 1;
  for (const Way each : ways_) yields += of(each).yield, left -= least_share_of(each);
  const double earned = yields > 0 ? of(way).yield / yields : 1 / static_cast<double>(ways_.size());
  return least_share_of(way) + left * earned;
}

void Effort::record(Way way, double work, double gain) {
  work = std::max(work, least_work);
  for (const Way each : ways_) of(each).credit += work * share_of(each);
  of(way).credit -= work;
  double& yield = of(way).yield;
  yield += (1 - std::exp(-work / memory)) * (gain / work - yield);
}

}  // namespace hexpipe::mwis::local_search
