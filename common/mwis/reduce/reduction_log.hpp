#pragma once
// Records the decisions of reductions in order, so that a solution of what they left can be lifted back.

#include <cstdint>
#include <span>
#include <vector>

namespace hexpipe::mwis::reduce {

// Choices have one byte per vertex, also for those that reductions created.
class ReductionLog {
 public:
  // v is in the solution.
  void take(std::int32_t v);
  // Begins a fold: v is in the solution unless one of the sets is. The vertices from `created` on stand for these sets,
  // in the order in which the sets are added.
  void begin_fold(std::int32_t v, std::int32_t created);
  void add_set(std::span<const std::int32_t> set);

  // The number of decisions; forget() goes back to an earlier size().
  std::size_t size() const { return steps_.size(); }
  void forget(std::size_t size);

  // Turns a solution of what is left into one of the whole graph.
  void lift(std::vector<std::uint8_t>& chosen) const;
  // Turns a solution of the whole graph into its choice within what is left.
  void project(std::vector<std::uint8_t>& chosen) const;

 private:
  struct Step {
    std::int32_t vertex;
    std::int32_t created;
    std::size_t first_set, last_set;  // an empty range for a vertex that is taken
  };
  std::span<const std::int32_t> set(std::size_t i) const {
    return std::span(members_).subspan(ends_[i], ends_[i + 1] - ends_[i]);
  }

  std::vector<Step> steps_;
  std::vector<std::size_t> ends_{0};
  std::vector<std::int32_t> members_;
};

}  // namespace hexpipe::mwis::reduce
