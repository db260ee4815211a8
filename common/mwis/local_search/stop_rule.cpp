#include "common/mwis/local_search/stop_rule.hpp"

#include <algorithm>

namespace hexpipe::mwis::local_search {

void StopRule::record(double work, std::int64_t weight, double most_times) {
  work_ = work;
  most_times_ = most_times;
  if (points_.empty() || weight > points_.back().weight) points_.push_back({work, weight});
  while (half_ + 1 < points_.size() && points_[half_ + 1].work <= work_ / 2) ++half_;
}

bool StopRule::is_done() const {
  if (least_gain_ <= 0 || work_ < least_work_ || points_.empty()) return false;
  const double to_whole = std::max(1.0, std::min(whole_work_ / work_, most_times_));
  return to_whole * static_cast<double>(points_.back().weight - points_[half_].weight) < least_gain_;
}

}  // namespace hexpipe::mwis::local_search
