#pragma once
// Distances along a field that add up around loops.

#include <cstdint>
#include <span>
#include <vector>

namespace hexpipe {

// Closed ways over numbered distances, of which each is taken forwards or backwards.
class Loops {
 public:
  void add_step(std::int32_t number, bool backwards) { steps_.push_back(backwards ? ~number : number); }
  // Ends the loop that was begun with the first step after the last one.
  void close() { ends_.push_back(static_cast<std::int64_t>(steps_.size())); }
  // Forgets the steps since the last close().
  void drop() { steps_.resize(static_cast<std::size_t>(ends_.back())); }
  std::size_t size() const { return ends_.size() - 1; }
  std::span<const std::int32_t> operator[](std::size_t loop) const {
    return std::span(steps_).subspan(ends_[loop], ends_[loop + 1] - ends_[loop]);
  }

 private:
  std::vector<std::int32_t> steps_;  // ~number where backwards
  std::vector<std::int64_t> ends_{0};
};

// What to add to the distances so that each loop comes back to where it began, as nearly as little enough does.
std::vector<float> curl_correction(std::span<const float> distances, const Loops& loops);

// Of its length, what a distance may gain or lose along an axis; where more is wanted, rows of a lattice have to end.
inline constexpr double most_strain = 0.3;

}  // namespace hexpipe
