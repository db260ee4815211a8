#pragma once
// What reductions decided, in order, so that a solution of what they left can be lifted back.

#include <cstdint>
#include <span>
#include <vector>

namespace hexpipe::mwis::reduce {

// Choices are a byte a vertex, those that reductions created included.
class ReductionLog {
 public:
  // v is in the solution.
  void take(std::int32_t v);
  // Opens a fold: v is in the solution unless one of the sets is, for which the vertices from `created` on stand, in
  // the order in which they are added.
  void begin_fold(std::int32_t v, std::int32_t created);
  void add_set(std::span<const std::int32_t> set);

  // How much was decided; forget() goes back to where size() was that.
  std::size_t size() const { return steps_.size(); }
  void forget(std::size_t size);

  // From a solution of what is left to one of the whole graph.
  void lift(std::vector<std::uint8_t>& chosen) const;
  // From a solution of the whole graph to what remains of it in what is left.
  void project(std::vector<std::uint8_t>& chosen) const;

 private:
  struct Step {
    std::int32_t vertex;
    std::int32_t created;
    std::size_t first_set, last_set;  // none where the vertex is taken
  };
  std::span<const std::int32_t> set(std::size_t i) const {
    return std::span(members_).subspan(ends_[i], ends_[i + 1] - ends_[i]);
  }

  std::vector<Step> steps_;
  std::vector<std::size_t> ends_{0};
  std::vector<std::int32_t> members_;
};

}  // namespace hexpipe::mwis::reduce
