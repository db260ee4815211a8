#include "tools/tetmesh/geometry/column_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/mesh/validity.hpp"
#include "tools/tetmesh/geometry/exact_geometry.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"

namespace hexpipe::tetmesh::geometry {

ColumnIndex::ColumnIndex(std::span<const Vec3> points, std::span<const Triangle> triangles)
    : points_(points), triangles_(triangles) {
  for (int axis = 0; axis < 2; ++axis) {
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    for (const Vec3& p : points) low = std::min(low, p[axis]), high = std::max(high, p[axis]);
    // About one column for each triangle, seen along z.
    counts_[axis] = std::clamp<std::int64_t>(std::llround(std::sqrt(static_cast<double>(triangles.size()))), 1, 4096);
    low_[axis] = low;
    width_[axis] = (high - low) / static_cast<double>(counts_[axis]);
  }
  offsets_.resize(static_cast<std::size_t>(counts_[0] * counts_[1]) + 1);
  for (const Triangle& t : triangles) for_each_column(t, [&](std::int64_t column) { ++offsets_[column + 1]; });
  for (std::size_t c = 0; c + 1 < offsets_.size(); ++c) offsets_[c + 1] += offsets_[c];
  members_.resize(offsets_.back());
  std::vector<std::int64_t> next = offsets_;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for_each_column(triangles[t],
                    [&](std::int64_t column) { members_[next[column]++] = static_cast<std::int32_t>(t); });
}

// Grows with `value`, so that a point between the ends of a triangle falls into one of the triangle's columns.
std::int64_t ColumnIndex::column_number(double value, int axis) const {
  const double number = width_[axis] > 0 ? std::floor((value - low_[axis]) / width_[axis]) : 0;
  return static_cast<std::int64_t>(std::clamp(number, 0.0, static_cast<double>(counts_[axis] - 1)));
}

template <class Visit>
void ColumnIndex::for_each_column(const Triangle& triangle, Visit&& visit) const {
  const auto columns_in = [&](const Box& box, auto&& take) {
    const std::int64_t last_x = column_number(box.high.x, 0), last_y = column_number(box.high.y, 1);
    for (std::int64_t y = column_number(box.low.y, 1); y <= last_y; ++y)
      for (std::int64_t x = column_number(box.low.x, 0); x <= last_x; ++x) take(y * counts_[0] + x);
  };
  const auto seen_along_z = [&](Vertex v) { return Vec3{points_[v].x, points_[v].y, 0}; };
  const TriangleSlices slices(seen_along_z(triangle[0]), seen_along_z(triangle[1]), seen_along_z(triangle[2]),
                              std::max(width_[0], width_[1]));
  slices.for_each_cell(columns_in, visit);
}

std::span<const std::int32_t> ColumnIndex::column_of(const Vec3& p) const {
  const std::int64_t column = column_number(p.y, 1) * counts_[0] + column_number(p.x, 0);
  return std::span(members_).subspan(offsets_[column], offsets_[column + 1] - offsets_[column]);
}

bool ColumnIndex::is_crossed(const Vec3& p, std::int32_t triangle) const {
  const Triangle& t = triangles_[triangle];
  const Vec3 &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
  if (std::max({a.z, b.z, c.z}) <= p.z) return false;
  // The line x = p.x (plus the small step) crosses two edges of the triangle's projection, or none. p lies between the
  // two when one is above p in y and the other is not.
  auto crossed_above = [&](const Vec3& u, const Vec3& v) {
    const bool u_left = u.x <= p.x, v_left = v.x <= p.x;
    if (u_left == v_left) return false;
    return u_left ? orientation_along_z(u, v, p) < 0 : orientation_along_z(v, u, p) < 0;
  };
  if ((crossed_above(a, b) != crossed_above(b, c)) == crossed_above(c, a)) return false;
  const int facing = orientation_along_z(a, b, c);
  return facing * orientation(a, b, c, p) < 0;
}

}  // namespace hexpipe::tetmesh::geometry
