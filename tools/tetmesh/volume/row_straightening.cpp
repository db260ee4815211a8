// The extra rows of a dislocation are a sheet of pairs of points; the line is the sheet's edge. Where the edge has a step,
// a pair stands at a corner: it has no pair beside it along the row, nor along the layers. Merging pairs at corners moves
// the step on, until it comes to the surface, or to a pair whose points are too far apart.

#include "tools/tetmesh/volume/row_straightening.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tools/tetmesh/geometry/half_edges.hpp"
#include "tools/tetmesh/geometry/sized_point_grid.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

double env(const char* n, double d) { return std::getenv(n) ? std::atof(std::getenv(n)) : d; }
// Two points of a pair are this far apart along an axis, in steps, and at most `aside` along the others.
const double nearest_pair = 0.3, furthest_pair = env("FP", 0.8), aside = 0.35;
// A point is the next one along an axis if it is that near to the step's end, in steps.
const double next_reach = env("NR", 0.75);
constexpr int most_passes = 30;

class Straightener {
 public:
  Straightener(std::span<const Vec3> fixed, std::vector<RowPoint> points)
      : points_(std::move(points)), fixed_count_(fixed.size()), grid_(points_.empty() ? Vec3{} : points_.front().at) {
    double longest = 0;
    for (const RowPoint& p : points_)
      for (const Vec3& step : p.steps) longest = std::max(longest, norm(step));
    length_ = longest;
    for (const Vec3& p : fixed) grid_.add(p, length_);
    for (const RowPoint& p : points_) grid_.add(p.at, length_);
    alive_.assign(points_.size(), true);
    number_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) number_[i] = static_cast<std::int32_t>(fixed_count_ + i);
    owner_.assign(fixed_count_, no_index);
    for (std::size_t i = 0; i < points_.size(); ++i) owner_.push_back(static_cast<std::int32_t>(i));
  }

  std::vector<RowPoint> run() {
    std::int64_t total = 0;
    for (int pass = 0; pass < most_passes; ++pass) {
      std::int64_t merged = 0;
      for (std::size_t i = 0; i < points_.size(); ++i)
        if (alive_[i] && merge_at(static_cast<std::int32_t>(i))) ++merged;
      total += merged;
      if (merged == 0) break;
    }
    if (std::getenv("SHOW")) fprintf(stderr, "merged %ld of %zu\n", (long)total, points_.size());
    std::vector<RowPoint> left;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (alive_[i]) left.push_back(points_[i]);
    return left;
  }

 private:
  bool is_there(std::int32_t n) const {
    return static_cast<std::size_t>(n) < fixed_count_ || (owner_[n] != no_index && alive_[owner_[n]] && number_[owner_[n]] == n);
  }
  static Vec3 in_steps(const std::array<Vec3, 3>& steps, const Vec3& way) {
    Eigen::Matrix3d m;
    m << steps[0].x, steps[1].x, steps[2].x, steps[0].y, steps[1].y, steps[2].y, steps[0].z, steps[1].z, steps[2].z;
    const Eigen::Vector3d c = m.inverse() * Eigen::Vector3d(way.x, way.y, way.z);
    return {c[0], c[1], c[2]};
  }
  std::int32_t next(const Vec3& place, double step) const {
    std::int32_t found = no_index;
    double least = next_reach * step * next_reach * step;
    grid_.for_each_near(place, next_reach * step, 0, [&](std::int32_t n) {
      if (!is_there(n)) return true;
      const double squared = norm_squared(grid_.points()[n] - place);
      if (squared < least) {
        least = squared;
        found = n;
      }
      return true;
    });
    return found;
  }
  // Whether a single point is ahead of both, along the axis in either sense.
  bool ends(const RowPoint& a, const RowPoint& b, std::size_t axis) const {
    for (const double sense : {1.0, -1.0}) {
      const Vec3 step = sense * a.steps[axis];
      const double length = norm(step);
      const std::int32_t one = next(a.at + step, length);
      if (one != no_index && one == next(b.at + step, length)) return true;
    }
    return false;
  }
  bool merge_at(std::int32_t i) {
    const RowPoint a = points_[i];
    const double reach = furthest_pair * std::max({norm(a.steps[0]), norm(a.steps[1]), norm(a.steps[2])});
    std::int32_t partner = no_index;
    grid_.for_each_near(a.at, reach, 0, [&](std::int32_t n) {
      if (static_cast<std::size_t>(n) < fixed_count_ || !is_there(n) || owner_[n] <= i) return true;
      const RowPoint& b = points_[owner_[n]];
      const Vec3 c = in_steps(a.steps, b.at - a.at);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int k = static_cast<int>(axis);
        const double along = std::abs(c[k]), first = std::abs(c[(k + 1) % 3]), second = std::abs(c[(k + 2) % 3]);
        if (along < nearest_pair || along > furthest_pair || first > aside || second > aside) continue;
        if (ends(a, b, (axis + 1) % 3) && ends(a, b, (axis + 2) % 3)) {
          partner = owner_[n];
          return false;
        }
      }
      return true;
    });
    if (partner == no_index) return false;
    points_[i].at = 0.5 * (a.at + points_[partner].at);
    alive_[partner] = false;
    number_[i] = grid_.add(points_[i].at, length_);
    owner_.push_back(i);
    return true;
  }

  std::vector<RowPoint> points_;
  std::size_t fixed_count_;
  double length_ = 0;
  geometry::SizedPointGrid grid_;      // the fixed points, then the others, and where they were merged
  std::vector<bool> alive_;
  std::vector<std::int32_t> number_;  // of each point in the grid
  std::vector<std::int32_t> owner_;   // of each number of the grid
};

}  // namespace

std::vector<RowPoint> straighten_row_ends(std::span<const Vec3> fixed, std::vector<RowPoint> points) {
  return Straightener(fixed, std::move(points)).run();
}

}  // namespace hexpipe::tetmesh::volume
