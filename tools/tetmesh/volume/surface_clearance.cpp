#include "tools/tetmesh/volume/surface_clearance.hpp"

#include <algorithm>
#include <cmath>

#include "tools/tetmesh/triangle_distance.hpp"

namespace hexpipe {

namespace {

// A square for each triangle would have this side.
double mean_spacing(const Surface& surface) {
  double area = 0;
  for (const auto& [a, b, c] : surface.triangles)
    area += norm(cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a])) / 2;
  return std::sqrt(area / static_cast<double>(surface.triangles.size()));
}

}  // namespace

SurfaceClearance::SurfaceClearance(const Surface& surface, const SizeField& clearance)
    : surface_(surface),
      clearance_(clearance),
      width_(std::max(clearance.greatest(), mean_spacing(surface))),
      low_(surface.points.front()),
      columns_(surface.points, surface.triangles) {
  for (const Vec3& p : surface.points) low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) file(static_cast<std::int32_t>(t));
  std::ranges::sort(entries_);
  for (std::size_t i = 0; i < entries_.size(); ++i) first_.try_emplace(entries_[i].first, i);
}

GridCell SurfaceClearance::cell_of(const Vec3& p) const {
  const auto index = [&](int axis) { return static_cast<std::int64_t>(std::floor((p[axis] - low_[axis]) / width_)); };
  return {index(0), index(1), index(2)};
}

// In the cells of which a point may be nearer than the clearance.
void SurfaceClearance::file(std::int32_t triangle) {
  const Triangle& t = surface_.triangles[triangle];
  const Vec3 &a = surface_.points[t[0]], &b = surface_.points[t[1]], &c = surface_.points[t[2]];
  const Vec3 area = cross(b - a, c - a), normal = area * (1 / norm(area));
  const double greatest = clearance_.greatest();
  const Vec3 reach{greatest, greatest, greatest};
  const GridCell low =
      cell_of(Vec3{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})} - reach);
  const GridCell high =
      cell_of(Vec3{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})} + reach);
  const double half_cell = width_ * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z)) / 2;
  GridCell i;
  for (i[2] = low[2]; i[2] <= high[2]; ++i[2])
    for (i[1] = low[1]; i[1] <= high[1]; ++i[1])
      for (i[0] = low[0]; i[0] <= high[0]; ++i[0]) {
        const Vec3 in_cells{static_cast<double>(i[0]) + 0.5, static_cast<double>(i[1]) + 0.5,
                            static_cast<double>(i[2]) + 0.5};
        const double height = std::abs(dot(normal, low_ + width_ * in_cells - a));
        if (height <= greatest + half_cell) entries_.emplace_back(cell_key(i), triangle);
      }
}

bool SurfaceClearance::is_clear(const Vec3& p) const {
  const std::uint64_t key = cell_key(cell_of(p));
  const auto found = first_.find(key);
  if (found == first_.end()) return true;
  const double least = clearance_.at(p);
  for (std::size_t e = found->second; e < entries_.size() && entries_[e].first == key; ++e) {
    const Triangle& t = surface_.triangles[entries_[e].second];
    const TriangleDistance distance(surface_.points[t[0]], surface_.points[t[1]], surface_.points[t[2]]);
    if (distance.squared(p) < least * least) return false;
  }
  return true;
}

}  // namespace hexpipe
