#pragma once
// Numbers side by side, on which one instruction does the same: the measures of several cells at once. Each lane is
// rounded as a double is, so that it holds the same bits as if it were alone. A vector extension of gcc and clang; two
// doubles are what every 64-bit processor has registers for.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "common/mesh/vec3.hpp"

namespace hexpipe {

inline constexpr int lane_count = 2;
using Lanes [[gnu::vector_size(lane_count * sizeof(double))]] = double;
// Of a comparison: all bits of a lane where it holds, else none.
using LaneMask [[gnu::vector_size(lane_count * sizeof(std::int64_t))]] = std::int64_t;

struct LaneVector {
  Lanes x{}, y{}, z{};
};

inline LaneVector operator+(const LaneVector& a, const LaneVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline LaneVector operator-(const LaneVector& a, const LaneVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Lanes dot(const LaneVector& a, const LaneVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline LaneVector cross(const LaneVector& a, const LaneVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Lanes det(const LaneVector& a, const LaneVector& b, const LaneVector& c) {
  return dot(a, cross(b, c));
}
inline Lanes norm_squared(const LaneVector& a) {
  return dot(a, a);
}

// What formulas for one number and for lanes need in place of a branch.
inline double select(bool condition, double yes, double no) {
  return condition ? yes : no;
}
inline Lanes select(LaneMask condition, Lanes yes, Lanes no) {
  return condition ? yes : no;
}
inline double absolute(double a) {
  return std::abs(a);
}
inline Lanes absolute(Lanes a) {
  return select(a < 0, -a, a);
}
inline double square_root(double a) {
  return std::sqrt(a);
}
inline Lanes square_root(Lanes a) {
  for (int lane = 0; lane < lane_count; ++lane) a[lane] = std::sqrt(a[lane]);
  return a;
}

// The corners of several cells, each as many as the first has, corner by corner.
template <std::size_t corner_count>
std::array<LaneVector, corner_count> side_by_side(const std::array<std::array<Vec3, corner_count>, lane_count>& cells) {
  std::array<LaneVector, corner_count> result;
  for (std::size_t c = 0; c < corner_count; ++c)
    for (int lane = 0; lane < lane_count; ++lane) {
      result[c].x[lane] = cells[lane][c].x;
      result[c].y[lane] = cells[lane][c].y;
      result[c].z[lane] = cells[lane][c].z;
    }
  return result;
}

}  // namespace hexpipe
