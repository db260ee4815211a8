#pragma once
// The nearest points of segments and triangles, one by one and in trees.

#include <array>
#include <optional>
#include <vector>

#include "common/mesh/box_tree.hpp"
#include "common/mesh/vec3.hpp"

namespace hexpipe::assemble::shape {

// Either may be degenerate.
Vec3 nearest_on_segment(const Vec3& a, const Vec3& b, const Vec3& to);
Vec3 nearest_on_triangle(const std::array<Vec3, 3>& triangle, const Vec3& to);

// True only if no point of the triangle is as near to `to` as that, a squared distance. Quicker than to find the
// nearest, and true of most triangles that are not the nearest of several.
bool is_surely_farther(const std::array<Vec3, 3>& triangle, const Vec3& to, double squared);

// A tree of things in these boxes, for nearest_in().
inline BoxTree tree_of(const std::vector<Box>& boxes) {
  return BoxTree(boxes, std::vector<double>(boxes.size()));
}

// The nearest of the points that point_of(thing) gives, if it gives one that is less than `most` away.
template <class PointOf>
std::optional<Vec3> nearest_in(const BoxTree& tree, const Vec3& to, double most, PointOf&& point_of) {
  std::optional<Vec3> best;
  double least = most;
  tree.least(to, 1, most, [&](std::int32_t thing) {
    const std::optional<Vec3> at = point_of(thing);
    const double distance = at ? norm(*at - to) : most;
    if (distance < least) least = distance, best = at;
    return distance;
  });
  return best;
}

}  // namespace hexpipe::assemble::shape
