#pragma once
// Points in a grid of cubes, to find those near a place.

#include <tsl/robin_map.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "common/mesh/vec3.hpp"
#include "tools/tetmesh/volume/cell_key.hpp"

namespace hexpipe {

class PointGrid {
 public:
  // Cells of this width around an origin, of which no point may be further than 10^6 widths along an axis.
  PointGrid(const Vec3& origin, double width) : origin_(origin), width_(width) {}

  void add(const Vec3& point) {
    const auto number = static_cast<std::int32_t>(points_.size());
    points_.push_back(point);
    const auto [head, is_new] = heads_.try_emplace(cell_key(cell_of(point)), number);
    next_.push_back(is_new ? none : head->second);
    if (!is_new) head.value() = number;
  }

  // In the order in which they were added.
  const std::vector<Vec3>& points() const { return points_; }

  // Calls visit(number of the point) for the points in all cells that come within `reach` of `place` along the axes.
  template <class Visit>
  void for_each_near(const Vec3& place, const Vec3& reach, Visit&& visit) const {
    const GridCell low = cell_of(place - reach), high = cell_of(place + reach);
    GridCell cell;
    for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2])
      for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1])
        for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
          const auto head = heads_.find(cell_key(cell));
          if (head == heads_.end()) continue;
          for (std::int32_t i = head->second; i != none; i = next_[i]) visit(i);
        }
  }
  template <class Visit>
  void for_each_near(const Vec3& place, double reach, Visit&& visit) const {
    for_each_near(place, Vec3{reach, reach, reach}, visit);
  }

 private:
  static constexpr std::int32_t none = -1;

  GridCell cell_of(const Vec3& p) const {
    const auto index = [&](int axis) {
      return static_cast<std::int64_t>(std::floor((p[axis] - origin_[axis]) / width_));
    };
    return {index(0), index(1), index(2)};
  }

  Vec3 origin_;
  double width_;
  std::vector<Vec3> points_;
  std::vector<std::int32_t> next_;  // in the same cell
  tsl::robin_map<std::uint64_t, std::int32_t, CellKeyHash> heads_;
};

}  // namespace hexpipe
