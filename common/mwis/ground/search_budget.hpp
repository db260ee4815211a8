#pragma once
// How much an exact search may spend: a number of nodes, which makes results repeatable, and a deadline, so that users
// need not wait.

#include <cstdint>
#include <limits>

#include "common/run/deadline.hpp"

namespace hexpipe::mwis::ground {

class SearchBudget {
 public:
  // For nodes that take some microseconds.
  static constexpr std::int64_t usual_nodes_a_look = 64;

  // Checks the clock once in `nodes_a_look` nodes.
  explicit SearchBudget(std::int64_t nodes = std::numeric_limits<std::int64_t>::max(),
                        const Deadline* deadline = nullptr, std::int64_t nodes_a_look = usual_nodes_a_look)
      : nodes_(nodes), left_(nodes), nodes_a_look_(nodes_a_look), deadline_(deadline) {}

  // Takes one node from the budget. False if none is left; it stays false.
  bool spend() {
    if (exhausted()) return false;
    --left_;
    return left_ % nodes_a_look_ != 0 ? !exhausted() : look_at_clock();
  }
  // For long nodes, in the middle of one. False if nothing is left.
  bool look_at_clock() {
    out_of_time_ = out_of_time_ || (deadline_ != nullptr && deadline_->passed());
    return !exhausted();
  }
  bool exhausted() const { return left_ <= 0 || out_of_time_; }
  std::int64_t spent() const { return nodes_ - left_; }

 private:
  std::int64_t nodes_, left_, nodes_a_look_;
  const Deadline* deadline_;
  bool out_of_time_ = false;
};

}  // namespace hexpipe::mwis::ground
