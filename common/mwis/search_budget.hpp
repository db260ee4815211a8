#pragma once
// How much an exact search may spend: a number of nodes, so that results repeat, and a deadline, so that users need not
// wait.

#include <cstdint>
#include <limits>

#include "common/run/deadline.hpp"

namespace hexpipe {

class SearchBudget {
 public:
  explicit SearchBudget(std::int64_t nodes = std::numeric_limits<std::int64_t>::max(),
                        const Deadline* deadline = nullptr)
      : nodes_(nodes), left_(nodes), deadline_(deadline) {}

  // Takes one node from the budget; false when there is none left, and from then on. A node costs some microseconds,
  // the clock is looked at every 64.
  bool spend() {
    if (exhausted()) return false;
    --left_;
    out_of_time_ = deadline_ != nullptr && left_ % 64 == 0 && deadline_->passed();
    return !exhausted();
  }
  bool exhausted() const { return left_ <= 0 || out_of_time_; }
  bool out_of_time() const { return out_of_time_; }
  std::int64_t spent() const { return nodes_ - left_; }

 private:
  std::int64_t nodes_, left_;
  const Deadline* deadline_;
  bool out_of_time_ = false;
};

}  // namespace hexpipe
