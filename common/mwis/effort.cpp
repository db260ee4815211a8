#include "common/mwis/effort.hpp"

#include <algorithm>
#include <cmath>

namespace hexpipe {
namespace {

// What was gained before so many nanoseconds of work in the same way counts a third.
constexpr double memory = 3e8;

}  // namespace

Way Effort::next() const {
  return of(Way::anneal).credit > of(Way::exact).credit ? Way::anneal : Way::exact;
}

double Effort::share_of(Way way) const {
  const double both = of(Way::exact).yield + of(Way::anneal).yield;
  if (both <= 0) return 0.5;
  return std::clamp(of(way).yield / both, least_share_, 1 - least_share_);
}

void Effort::record(Way way, double work, double gain) {
  if (work <= 0) return;
  for (const Way each : all_ways) of(each).credit += work * share_of(each);
  of(way).credit -= work;
  double& yield = of(way).yield;
  yield += (1 - std::exp(-work / memory)) * (gain / work - yield);
}

}  // namespace hexpipe
