#pragma once
// Points that come one by one, and those of them near a place.

#include <tsl/robin_map.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "common/mesh/vec3.hpp"

namespace hexpipe {

class SurfacePointGrid {
 public:
  // Asks for all points within `reach` along every axis, and some more.
  explicit SurfacePointGrid(double reach) : reach_(reach) {}

  // Returns the number of the point, from 0.
  std::int32_t add(const Vec3& p) {
    const auto number = static_cast<std::int32_t>(points_.size());
    points_.push_back(p);
    const auto [found, fresh] = last_in_cell_.insert({cell_of(p), number});
    previous_.push_back(fresh ? -1 : found->second);
    found.value() = number;
    return number;
  }

  // Whether hits(number, point) is false for all points near p.
  template <class Hits>
  bool none_near(const Vec3& p, Hits&& hits) const {
    const Cell centre = cell_of(p);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz)
          if (hit_in({centre.x + dx, centre.y + dy, centre.z + dz}, hits)) return false;
    return true;
  }

 private:
  struct Cell {
    std::int64_t x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      const auto mix = static_cast<std::uint64_t>(c.x) * 0x9e3779b97f4a7c15u ^
                       static_cast<std::uint64_t>(c.y) * 0xc2b2ae3d27d4eb4fu ^
                       static_cast<std::uint64_t>(c.z) * 0x165667b19e3779f9u;
      return static_cast<std::size_t>(mix ^ mix >> 29);
    }
  };

  Cell cell_of(const Vec3& p) const { return {number_of(p.x), number_of(p.y), number_of(p.z)}; }
  std::int64_t number_of(double x) const { return static_cast<std::int64_t>(std::floor(x / reach_)); }

  template <class Hits>
  bool hit_in(const Cell& cell, Hits&& hits) const {
    const auto found = last_in_cell_.find(cell);
    if (found == last_in_cell_.end()) return false;
    for (std::int32_t i = found->second; i >= 0; i = previous_[i])
      if (hits(i, points_[i])) return true;
    return false;
  }

  double reach_;
  std::vector<Vec3> points_;
  std::vector<std::int32_t> previous_;  // in the same cell
  tsl::robin_map<Cell, std::int32_t, Hash> last_in_cell_;
};

}  // namespace hexpipe
