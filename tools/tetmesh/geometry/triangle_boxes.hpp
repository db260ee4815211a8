#pragma once
// Boxes around triangles and around slices of them, for grids and trees.
//
// A long narrow triangle that does not lie along the axes has a box much larger than itself, which overlaps the boxes
// of all its neighbours. Cut across its longest side, the triangle has small boxes that lie along it.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::tetmesh::geometry {

using hexpipe::Box;
using hexpipe::BoxTree;

class TriangleSlices {
 public:
  // Makes slices about as long as `length`, which may be 0; one slice where the triangle's box is hardly larger than
  // the triangle.
  TriangleSlices(const Vec3& a, const Vec3& b, const Vec3& c, double length)
      : box_(Box::around(std::array{a, b, c})), a_(a), b_(b), c_(c) {
    const Vec3 extent = box_.high - box_.low;
    const double sides = extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
    if (sides <= most_sides * norm(cross(b - a, c - a))) return;
    turn_longest_side_first();
    const double count = norm(b_ - a_) / length;
    if (count >= least_count) count_ = static_cast<int>(std::min(count, static_cast<double>(most_count)));
  }

  int count() const { return count_; }
  // The box of the whole triangle.
  const Box& box() const { return box_; }

  // Calls visit(box) for boxes that cover the triangle, with room for rounding, and that lie in the triangle's box.
  template <class Visit>
  void for_each_box(Visit&& visit) const {
    if (count_ == 1) return visit(box_);
    const Vec3 along = b_ - a_;
    const double apex = std::clamp(dot(c_ - a_, along) / norm_squared(along), 0.0, 1.0);
    std::array before{a_, a_};
    for (int slice = 1; slice <= count_; ++slice) {
      const double from = static_cast<double>(slice - 1) / count_, to = static_cast<double>(slice) / count_;
      const std::array after{a_ + to * along, beyond(to, apex)};
      Box box = Box::around(std::array{before[0], before[1], after[0], after[1]});
      if (from <= apex && apex <= to) box.add({c_, c_});
      visit(within(box));
      before = after;
    }
  }

  // Calls visit(cell) once for each cell of a grid that the slices may reach, in ascending order if there are several
  // slices. cells_in(box, take) calls take(cell) for the cells that a box reaches.
  template <class CellsIn, class Visit>
  void for_each_cell(CellsIn&& cells_in, Visit&& visit) const {
    if (count_ == 1) return cells_in(box_, std::forward<Visit>(visit));
    std::vector<std::int64_t> cells;
    for_each_box([&](const Box& box) { cells_in(box, [&](std::int64_t cell) { cells.push_back(cell); }); });
    std::ranges::sort(cells);
    cells.erase(std::ranges::unique(cells).begin(), cells.end());
    for (const std::int64_t cell : cells) visit(cell);
  }

 private:
  // A triangle stays whole where half the surface of its box is at most this many times twice the triangle's area. That
  // ratio is at most 1.5 for triangles along the axes, and about 2 for most others.
  static constexpr double most_sides = 8;
  // Fewer slices gain nothing. More slices only help single slivers that are thinner than all other triangles.
  static constexpr int least_count = 3, most_count = 1024;

  void turn_longest_side_first() {
    const double ab = norm_squared(b_ - a_), bc = norm_squared(c_ - b_), ca = norm_squared(a_ - c_);
    if (ab >= bc && ab >= ca) return;
    if (bc >= ca)
      std::tie(a_, b_, c_) = std::tuple(b_, c_, a_);
    else
      std::tie(a_, b_, c_) = std::tuple(c_, a_, b_);
  }
  // The point on the two shorter sides that is this far along the longest side.
  Vec3 beyond(double at, double apex) const {
    return at < apex ? a_ + (at / apex) * (c_ - a_) : c_ + ((at - apex) / std::max(1 - apex, least)) * (b_ - c_);
  }
  // Corners of slices are rounded by less than this.
  Box within(const Box& slice) const {
    double greatest = 0;
    for (int axis = 0; axis < 3; ++axis)
      greatest = std::max({greatest, std::abs(box_.low[axis]), std::abs(box_.high[axis])});
    const double room = 16 * std::numeric_limits<double>::epsilon() * greatest;
    const auto low = [&](int axis) { return std::max(slice.low[axis] - room, box_.low[axis]); };
    const auto high = [&](int axis) { return std::min(slice.high[axis] + room, box_.high[axis]); };
    return {{low(0), low(1), low(2)}, {high(0), high(1), high(2)}};
  }

  static constexpr double least = std::numeric_limits<double>::min();
  Box box_;
  Vec3 a_, b_, c_;  // once cut, the longest side leads from a to b
  int count_ = 1;
};

// The length for trees and similar structures, where each slice costs memory: the side of a square of twice the mean
// area, but long enough that a triangle has at most 64 slices on average.
double length_of_slices(std::span<const Vec3> points, std::span<const Triangle> triangles);

// A tree of triangles, each in the boxes of its slices. The values are 0, so that least() with a slope of 1 finds
// distances.
BoxTree tree_of_triangles(std::span<const Vec3> points, std::span<const Triangle> triangles);

}  // namespace hexpipe::tetmesh::geometry
