#pragma once
// Paths over numbered distances, most of which come back to where they began.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hexpipe::tetmesh::fields {

// A numbered distance on a path, forwards or backwards.
struct LoopStep {
  std::int32_t number;
  bool backwards;
};

// Paths over distances whose sum is known. The sum is 0 for a path that comes back to where it began, a loop.
class Loops {
 public:
  void add_step(std::int32_t number, bool backwards) { steps_.push_back(backwards ? ~number : number); }
  void add_step(const LoopStep& step) { add_step(step.number, step.backwards); }
  // Ends the path that began with the first step after the last one.
  void close(double sum = 0) {
    ends_.push_back(static_cast<std::int64_t>(steps_.size()));
    sums_.push_back(static_cast<float>(sum));
  }
  // Appends the closed paths of others after its own.
  void append(const Loops& others) {
    const std::int64_t before = ends_.back();
    steps_.insert(steps_.end(), others.steps_.begin(), others.steps_.end());
    for (std::size_t i = 1; i < others.ends_.size(); ++i) ends_.push_back(before + others.ends_[i]);
    sums_.insert(sums_.end(), others.sums_.begin(), others.sums_.end());
  }
  // Forgets the steps since the last close().
  void drop() { steps_.resize(static_cast<std::size_t>(ends_.back())); }
  std::size_t size() const { return ends_.size() - 1; }
  float sum_of(std::size_t loop) const { return sums_[loop]; }
  std::span<const std::int32_t> operator[](std::size_t loop) const {
    return std::span(steps_).subspan(ends_[loop], ends_[loop + 1] - ends_[loop]);
  }

 private:
  std::vector<std::int32_t> steps_;  // ~number if backwards
  std::vector<std::int64_t> ends_{0};
  std::vector<float> sums_;
};

}  // namespace hexpipe::tetmesh::fields
