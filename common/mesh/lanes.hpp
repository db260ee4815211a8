#pragma once
// Numbers side by side, so that one instruction handles several: the measures of several cells at once. Each lane is
// rounded like a double, so it holds the same bits as if it were alone. Lanes are a vector extension of gcc and clang;
// on a processor with narrower registers they occupy several. How functions pass and return lanes depends on the
// processor that they are compiled for, so functions that are not inlined pass them by reference.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/mesh/vec3.hpp"

// Compiles a function, with everything that it calls, once more for processors with wider registers (AVX2, AVX-512).
// The program chooses one version when it starts; all give the same bits. The sanitizers do not work yet at that
// moment.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define HEXPIPE_ANY_REGISTERS [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"), gnu::flatten]]
#else
#define HEXPIPE_ANY_REGISTERS
#endif

#pragma GCC diagnostic ignored "-Wpsabi"  // about passing lanes

namespace hexpipe {

inline constexpr int lane_count = 8;
using Lanes [[gnu::vector_size(lane_count * sizeof(double))]] = double;
// The result of a comparison: all bits of a lane are set where it holds, none otherwise.
using LaneMask [[gnu::vector_size(lane_count * sizeof(std::int64_t))]] = std::int64_t;

// Lanes in memory are aligned as functions for wide registers need it; code compiled for narrow ones would not do that.
inline constexpr std::size_t lane_bytes = lane_count * sizeof(double);

struct alignas(lane_bytes) LaneVector {
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
// The same with one vector for all lanes.
inline Lanes dot(const LaneVector& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline LaneVector cross(const Vec3& a, const LaneVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Lanes det(const LaneVector& a, const LaneVector& b, const LaneVector& c) {
  return dot(a, cross(b, c));
}
inline Lanes norm_squared(const LaneVector& a) {
  return dot(a, a);
}

// A choice without a branch, for formulas that work on one number or on lanes.
inline double select(bool condition, double yes, double no) {
  return condition ? yes : no;
}
inline Lanes select(const LaneMask& condition, const Lanes& yes, const Lanes& no) {
  return condition ? yes : no;
}
inline double absolute(double a) {
  return std::abs(a);
}
inline Lanes absolute(const Lanes& a) {
  return select(a < 0, -a, a);
}
inline double square_root(double a) {
  return std::sqrt(a);
}
inline Lanes square_root(const Lanes& a) {
  Lanes result;
  for (int lane = 0; lane < lane_count; ++lane) result[lane] = std::sqrt(a[lane]);
  return result;
}

// Bit i is set where lane i is.
inline std::uint32_t bits_of(const LaneMask& mask) {
  std::uint32_t bits = 0;
  for (int lane = 0; lane < lane_count; ++lane) bits |= static_cast<std::uint32_t>(mask[lane] & 1) << lane;
  return bits;
}

// The corners of several cells, corner by corner; all cells have as many corners as the first.
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
