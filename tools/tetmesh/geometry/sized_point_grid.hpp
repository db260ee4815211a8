#pragma once
// Points that are added one by one, each with a length that holds at its place. Finds the points near a place.
//
// There is one grid for every octave of lengths, with cells as wide as these. So where lengths differ a hundredfold,
// points with small lengths do not crowd a cell, and points with large ones do not spread over many cells.

#include <tsl/robin_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/mesh/vec3.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"

namespace hexpipe::tetmesh::geometry {

// A cell of a grid of cubes; its key in a hash map.
using GridCell = std::array<std::int64_t, 3>;

// Keys differ for cells within 2^20 of the origin.
constexpr std::uint64_t cell_key(const GridCell& cell) {
  constexpr std::int64_t middle = 1 << 20;
  std::uint64_t key = 0;
  for (const std::int64_t i : cell) key = key << 21 | static_cast<std::uint64_t>(i + middle);
  return key;
}

// Four cells in a row along x have hashes that follow each other, so that a search, which looks at cells row by row,
// finds them side by side in memory.
struct CellKeyHash {
  std::size_t operator()(std::uint64_t key) const {
    constexpr int place_of_x = 42;
    constexpr std::uint64_t in_row = 3;
    const std::uint64_t row = (key & ~(in_row << place_of_x)) * 0x9e3779b97f4a7c15u;
    return ((row ^ row >> 32) & ~in_row) | (key >> place_of_x & in_row);
  }
};

class SizedPointGrid {
 public:
  // No point may be further than 10^6 of its lengths from the origin along an axis.
  explicit SizedPointGrid(const Vec3& origin) : origin_(origin) {}
  // For points of any lengths in a box.
  explicit SizedPointGrid(const Box& box)
      : origin_(box.low), least_width_((box.high - box.low)[box.longest_axis()] / most_cells) {}

  // Returns the number of the point, from 0.
  std::int32_t add(const Vec3& p, double length) {
    const auto number = static_cast<std::int32_t>(points_.size());
    points_.push_back(p);
    Octave& octave = octave_of(length);
    const auto [head, is_new] = octave.heads.try_emplace(cell_key(cell_of(p, octave.width)), number);
    next_.push_back(is_new ? no_index : head->second);
    if (!is_new) head.value() = number;
    return number;
  }

  // In the order in which they were added.
  const std::vector<Vec3>& points() const { return points_; }

  // Calls visit(number) for the points within `reach` of p along every axis, and for some others, until it returns
  // false. It may leave out points whose length is below `least`.
  template <class Visit>
  void for_each_near(const Vec3& p, const Vec3& reach, double least, Visit&& visit) const {
    for (const Octave& octave : octaves_)
      if (2 * octave.width >= least && !visit_octave(octave, p, reach, visit)) return;
  }
  template <class Visit>
  void for_each_near(const Vec3& p, double reach, double least, Visit&& visit) const {
    for_each_near(p, Vec3{reach, reach, reach}, least, visit);
  }
  // Whether test(number) is true for all of these points. Those in the cell of p come first: they are the nearest, and
  // where one of them fails, the search ends.
  template <class Test>
  bool all_near(const Vec3& p, const Vec3& reach, double least, Test&& test) const {
    for (const Octave& octave : octaves_)
      if (2 * octave.width >= least && !visit_cell(octave, cell_of(p, octave.width), test)) return false;
    for (const Octave& octave : octaves_)
      if (2 * octave.width >= least && !visit_octave(octave, p, reach, test)) return false;
    return true;
  }

 private:
  static constexpr double most_cells = 1e6;  // along an axis

  struct Octave {
    double width;
    tsl::robin_map<std::uint64_t, std::int32_t, CellKeyHash> heads = {};
  };

  // Widths are powers of two times the first length.
  Octave& octave_of(double length) {
    length = std::max(length, least_width_);
    if (octaves_.empty()) first_ = length;
    const double width = first_ * std::exp2(std::floor(std::log2(length / first_) + 1e-6));
    const auto found = std::ranges::find(octaves_, width, &Octave::width);
    return found != octaves_.end() ? *found : octaves_.emplace_back(Octave{width});
  }

  GridCell cell_of(const Vec3& p, double width) const {
    const auto index = [&](int axis) {
      return static_cast<std::int64_t>(std::floor((p[axis] - origin_[axis]) / width));
    };
    return {index(0), index(1), index(2)};
  }

  template <class Visit>
  bool visit_octave(const Octave& octave, const Vec3& p, const Vec3& reach, Visit&& visit) const {
    const GridCell low = cell_of(p - reach, octave.width), high = cell_of(p + reach, octave.width);
    GridCell cell;
    for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2])
      for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
        for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0])
          if (!visit_cell(octave, cell, visit)) return false;
    return true;
  }

  template <class Visit>
  bool visit_cell(const Octave& octave, const GridCell& cell, Visit&& visit) const {
    const auto head = octave.heads.find(cell_key(cell));
    if (head == octave.heads.end()) return true;
    for (std::int32_t i = head->second; i != no_index; i = next_[i])
      if (!visit(i)) return false;
    return true;
  }

  Vec3 origin_;
  double least_width_ = 0, first_ = 0;
  std::vector<Octave> octaves_;
  std::vector<Vec3> points_;
  std::vector<std::int32_t> next_;  // the next point in the same cell
};

}  // namespace hexpipe::tetmesh::geometry
