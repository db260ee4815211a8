#include "common/mwis/local_search/stop_rule.hpp"

#include <algorithm>
#include <cmath>

namespace hexpipe::mwis::local_search {
namespace {

// A search of a large graph that gained less than this many times what is worth it, and nothing in its last half, gains
// nothing more: on graphs of hexes of 81,000 to 250,000 vertices, three seeds each, no gain came later. Small ones may:
// block-28k gains for long, after pauses.
constexpr double few_gains = 10;

}  // namespace

void StopRule::record(double work, std::int64_t weight, double most_times, bool has_seen_all) {
  work_ = work;
  most_times_ = most_times;
  has_seen_all_ = has_seen_all;
  if (points_.empty() || weight > points_.back().weight) points_.push_back({work, weight});
  while (half_ + 1 < points_.size() && points_[half_ + 1].work <= work_ / 2) ++half_;
}

bool StopRule::is_done() const {
  if (least_gain_ <= 0 || points_.empty()) return false;
  const auto gain_since = [&](const Point& point) { return static_cast<double>(points_.back().weight - point.weight); };
  const double all = gain_since(points_.front()), recent = gain_since(points_[half_]);
  const bool gains_little = all < least_gain_,
             has_ended = std::isfinite(most_times_) && recent == 0 && all < few_gains * least_gain_;
  if (work_ < least_work_ && !(has_seen_all_ && (gains_little || has_ended))) return false;
  double times = whole_work_ / work_;
  if (gains_little) times = std::min(times, most_times_);
  return std::max(1.0, times) * recent < least_gain_;
}

}  // namespace hexpipe::mwis::local_search
