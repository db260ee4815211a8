#pragma once
// How much an exact search may spend: a number of nodes, so that results repeat, and a deadline, so that users need not
// wait.

#include <cstdint>
#include <limits>

#include "common/run/deadline.hpp"

namespace hexpipe::mwis::ground {

class SearchBudget {
 public:
  // For nodes of some microseconds.
  static constexpr std::int64_t usual_nodes_a_look = 64;

  // Looks at the clock once in `nodes_a_look` nodes.
  explicit SearchBudget(std::int64_t nodes = std::numeric_limits<std::int64_t>::max(),
                        const Deadline* deadline = nullptr, std::int64_t nodes_a_look = usual_nodes_a_look)
      : nodes_(nodes), left_(nodes), nodes_a_look_(nodes_a_look), deadline_(deadline) {}

  // Takes one node from the budget; false when there is none left, and from then on.
  bool spend() {
    if (exhausted()) return false;
    --left_;
    return left_ % nodes_a_look_ != 0 ? !exhausted() : look_at_clock();
  }
  // In the middle of a node that takes long; false when nothing is left.
  bool look_at_clock() {
    out_of_time_ = out_of_time_ || (deadline_ != nullptr && deadline_->passed());
    return !exhausted();
  }
  bool exhausted() const { return left_ <= 0 || out_of_time_; }
  bool out_of_time() const { return out_of_time_; }
  std::int64_t spent() const { return nodes_ - left_; }

 private:
  std::int64_t nodes_, left_, nodes_a_look_;
  const Deadline* deadline_;
  bool out_of_time_ = false;
};

}  // namespace hexpipe::mwis::ground
