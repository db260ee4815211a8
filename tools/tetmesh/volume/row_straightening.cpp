// The extra rows of a dislocation are a sheet of pairs of points, and the line is the sheet's edge. Where the edge has
// a step, a pair stands at a corner: along its row and along the layers, a single point follows on the two. Merging
// pairs at corners moves the step on, until it comes to the surface, or to a pair whose points are too far apart.

#include "tools/tetmesh/volume/row_straightening.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "tools/tetmesh/fields/lattice_steps.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

// How far apart the points of a pair are along one axis, in steps, and at most along the others. At the ends of rows
// inside mambo-m1, s1, s22 and s27, 88.5 % of the cells are hexes with pairs of up to 0.8 steps, 89.9 with 1.
constexpr double nearest_pair = 0.3, furthest_pair = 1.0, furthest_aside = 0.5;
// A point within this distance of the end of a step, in its lengths, is the next one.
constexpr double reach_of_step = 0.75;
// Pairs within this many steps of a merge are looked at again.
constexpr double reach_of_change = 2;
// A step of an edge moves on by one pair in each pass.
constexpr int most_passes = 30;

// The axis along which two points are a pair.
std::optional<std::size_t> axis_of_pair(const Vec3& apart) {
  for (int k = 0; k < 3; ++k) {
    const double along = std::abs(apart[k]);
    const double aside = std::max(std::abs(apart[(k + 1) % 3]), std::abs(apart[(k + 2) % 3]));
    if (along >= nearest_pair && along <= furthest_pair && aside <= furthest_aside) return static_cast<std::size_t>(k);
  }
  return std::nullopt;
}

class EndStraightener {
 public:
  EndStraightener(std::span<const Vec3> fixed, std::vector<RowPoint> points)
      : points_(std::move(points)), place_of_(points_.size()), grid_(points_.front().at) {
    for (const RowPoint& p : points_) width_ += longest_step(p) / static_cast<double>(points_.size());
    fill_grid(fixed);
  }

  std::vector<RowPoint> run() {
    std::vector<std::int32_t> waiting(points_.size());
    std::iota(waiting.begin(), waiting.end(), 0);
    for (int pass = 0; !waiting.empty() && pass < most_passes; ++pass) {
      changed_.clear();
      for (const std::int32_t i : waiting) merge_at(i);
      waiting = beside_changes();
    }
    std::vector<RowPoint> left;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (place_of_[i] != no_index) left.push_back(points_[i]);
    return left;
  }

 private:
  static double longest_step(const RowPoint& p) {
    return std::max({norm(p.steps[0]), norm(p.steps[1]), norm(p.steps[2])});
  }
  void fill_grid(std::span<const Vec3> fixed);
  std::int32_t add(const Vec3& at, std::int32_t point) {
    point_at_.push_back(point);
    is_taken_.push_back(true);
    return grid_.add(at, width_);
  }
  void leave(std::int32_t i) { is_taken_[std::exchange(place_of_[i], no_index)] = false; }
  std::int32_t nearest(const Vec3& to, double reach) const;
  // By axis and sense: the place of the next point in the grid, or no_index; searched when first asked for.
  using NextPoints = std::array<std::optional<std::int32_t>, 6>;
  bool come_together(const RowPoint& a, const Vec3& b, std::size_t axis, NextPoints& next_of_a) const;
  std::int32_t partner_of(std::int32_t i) const;
  void merge_at(std::int32_t i);
  std::vector<std::int32_t> beside_changes() const;

  std::vector<RowPoint> points_;
  std::vector<std::int32_t> place_of_;  // of each point in the grid; no_index: it was merged into another
  geometry::SizedPointGrid grid_;
  double width_ = 0;                    // of the grid: the mean of the longest steps
  std::vector<std::int32_t> point_at_;  // by place in the grid; no_index: it is fixed
  std::vector<bool> is_taken_;          // by place in the grid
  std::vector<std::int32_t> changed_;   // points that others were merged into in this pass
};

// Points come in no order of space. In the grid they stand in the order of its cells, so that those around a point are
// near each other in memory, whose latency is the time of a search.
void EndStraightener::fill_grid(std::span<const Vec3> fixed) {
  const Vec3& origin = points_.front().at;
  const auto cell_of = [&](const Vec3& p) {
    const auto along = [&](int axis) {
      return static_cast<std::int64_t>(std::floor((p[axis] - origin[axis]) / width_));
    };
    return geometry::GridCell{along(2), along(1), along(0)};
  };
  struct Placed {
    geometry::GridCell cell;
    std::int32_t number;  // of the fixed points, then of the others
  };
  std::vector<Placed> order;
  order.reserve(fixed.size() + points_.size());
  for (const Vec3& p : fixed) order.push_back({cell_of(p), static_cast<std::int32_t>(order.size())});
  for (const RowPoint& p : points_) order.push_back({cell_of(p.at), static_cast<std::int32_t>(order.size())});
  std::ranges::sort(order, {}, [](const Placed& p) { return std::pair(p.cell, p.number); });
  const auto fixed_count = static_cast<std::int32_t>(fixed.size());
  for (const auto& [cell, number] : order) {
    if (number < fixed_count)
      add(fixed[number], no_index);
    else
      place_of_[number - fixed_count] = add(points_[number - fixed_count].at, number - fixed_count);
  }
}

// The place in the grid, or no_index.
std::int32_t EndStraightener::nearest(const Vec3& to, double reach) const {
  std::int32_t found = no_index;
  double least = reach * reach;
  grid_.for_each_near(to, reach, 0, [&](std::int32_t place) {
    const double squared = norm_squared(grid_.points()[place] - to);
    if (is_taken_[place] && squared < least) {
      least = squared;
      found = place;
    }
    return true;
  });
  return found;
}

// Whether a single point is the next one of both, along the axis in either sense.
bool EndStraightener::come_together(const RowPoint& a, const Vec3& b, std::size_t axis, NextPoints& next_of_a) const {
  const double reach = reach_of_step * norm(a.steps[axis]);
  for (const bool backwards : {false, true}) {
    const Vec3 step = (backwards ? -1.0 : 1.0) * a.steps[axis];
    auto& next = next_of_a[2 * axis + (backwards ? 1 : 0)];
    if (!next) next = nearest(a.at + step, reach);
    if (*next == no_index) continue;
    // In a regular lattice it is out of reach, which spares nearly all further searches.
    if (norm_squared(grid_.points()[*next] - (b + step)) >= reach * reach) continue;
    if (*next == nearest(b + step, reach)) return true;
  }
  return false;
}

// A later point that is a pair with this one, at a corner; no_index if there is none.
std::int32_t EndStraightener::partner_of(std::int32_t i) const {
  const RowPoint& a = points_[i];
  const fields::InSteps in_steps(a.steps);
  NextPoints next;
  std::int32_t partner = no_index;
  grid_.for_each_near(a.at, furthest_pair * longest_step(a), 0, [&](std::int32_t place) {
    const std::int32_t other = point_at_[place];
    if (!is_taken_[place] || other <= i) return true;
    const Vec3& b = grid_.points()[place];
    const auto axis = axis_of_pair(in_steps(b - a.at));
    if (axis && come_together(a, b, (*axis + 1) % 3, next) && come_together(a, b, (*axis + 2) % 3, next))
      partner = other;
    return partner == no_index;
  });
  return partner;
}

void EndStraightener::merge_at(std::int32_t i) {
  if (place_of_[i] == no_index) return;
  const std::int32_t partner = partner_of(i);
  if (partner == no_index) return;
  points_[i].at = 0.5 * (points_[i].at + points_[partner].at);
  leave(partner);
  leave(i);
  place_of_[i] = add(points_[i].at, i);
  changed_.push_back(i);
}

// The points whose pairs may stand at a corner now, ascending.
std::vector<std::int32_t> EndStraightener::beside_changes() const {
  std::vector<std::int32_t> beside;
  for (const std::int32_t i : changed_)
    grid_.for_each_near(points_[i].at, reach_of_change * longest_step(points_[i]), 0, [&](std::int32_t place) {
      if (is_taken_[place] && point_at_[place] != no_index) beside.push_back(point_at_[place]);
      return true;
    });
  std::ranges::sort(beside);
  beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
  return beside;
}

}  // namespace

std::vector<RowPoint> straighten_row_ends(std::span<const Vec3> fixed, std::vector<RowPoint> points) {
  if (points.empty()) return points;
  return EndStraightener(fixed, std::move(points)).run();
}

}  // namespace hexpipe::tetmesh::volume
