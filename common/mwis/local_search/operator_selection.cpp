#include "common/mwis/local_search/operator_selection.hpp"

#include <algorithm>
#include <cmath>

namespace hexpipe::mwis::local_search {
namespace {

// Gains made before this many nanoseconds of work with the same operator count a third.
constexpr double memory = 3e8;

}  // namespace

Operator OperatorSelection::next() const {
  return *std::ranges::max_element(operators_, {},
                                   [this](Operator op) { return score_of(op).credit - score_of(op).cost; });
}

double OperatorSelection::share_of(Operator op) const {
  double yields = 0, left = 1;
  for (const Operator each : operators_) yields += score_of(each).yield, left -= least_shares_[index_of(each)];
  const double earned = yields > 0 ? score_of(op).yield / yields : 1 / static_cast<double>(operators_.size());
  return least_shares_[index_of(op)] + left * earned;
}

void OperatorSelection::record(Operator op, double work, double gain) {
  work = std::max(work, least_work);
  for (const Operator each : operators_) score_of(each).credit += work * share_of(each);
  score_of(op).credit -= work;
  double& yield = score_of(op).yield;
  yield += (1 - std::exp(-work / memory)) * (gain / work - yield);
}

}  // namespace hexpipe::mwis::local_search
