#include "tools/tetmesh/surface/surface_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/geometry/triangle_boxes.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// The most cells along each axis, so that a small width does not fill the memory.
constexpr double most_cells = 256;
constexpr int most_samples_along_edge = 64;
constexpr std::int64_t triangles_per_block = 256, triangles_per_probe = 64;

int parts_of(double length, double spacing) {
  return std::clamp(static_cast<int>(std::ceil(length / spacing)), 1, most_samples_along_edge);
}

// A vertex is a sample of the first triangle that has it. Points of an edge are samples of the triangle in which the
// edge runs from its lower to its higher vertex.
class SurfaceSampler {
 public:
  SurfaceSampler(std::span<const Vec3> points, std::span<const Triangle> triangles, const sizing::SizeField& spacing)
      : points_(points), triangles_(triangles), spacing_(spacing), owner_(points.size(), no_index) {
    for (std::size_t t = triangles.size(); t-- > 0;)
      for (const Vertex v : triangles[t]) owner_[v] = static_cast<std::int32_t>(t);
  }

  template <class Visit>
  void for_each_sample(std::int64_t triangle, Visit&& visit) const {
    const Triangle& t = triangles_[triangle];
    double longest = 0;
    std::size_t base = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex from = t[i], to = t[(i + 1) % 3];
      const Vec3 start = points_[from], along = points_[to] - start;
      const double length = norm(along);
      if (length > longest) longest = length, base = i;
      if (owner_[from] == triangle) visit(start);
      if (from > to) continue;
      const int parts = parts_of(length, spacing_.at(start + 0.5 * along));
      for (int part = 1; part < parts; ++part) visit(start + (static_cast<double>(part) / parts) * along);
    }
    // Samples lie in rows along the longest side, so that slivers need none.
    const Vec3 &a = points_[t[base]], &b = points_[t[(base + 1) % 3]], &c = points_[t[(base + 2) % 3]];
    const double spacing = spacing_.at((a + b + c) * (1.0 / 3)), height = norm(cross(b - a, c - a)) / longest;
    const int rows = parts_of(height, spacing);
    for (int row = 1; row < rows; ++row) {
      const double up = static_cast<double>(row) / rows;
      const int parts = parts_of((1 - up) * longest, spacing);
      for (int part = 1; part < parts; ++part) visit(a + up * (c - a) + ((1 - up) * part / parts) * (b - a));
    }
  }

 private:
  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  const sizing::SizeField& spacing_;
  std::vector<std::int32_t> owner_;  // by vertex: a triangle
};

}  // namespace

DistanceIndex::DistanceIndex(std::span<const Vec3> points, std::span<const Triangle> triangles)
    : points_(points), triangles_(triangles), low_(points[0]) {
  Vec3 high = low_;
  for (const Vec3& p : points) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 extent = high - low_;
  double area = 0;
  bounds_.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    const Vec3 ab = points[b] - points[a], ac = points[c] - points[a], normal = cross(ab, ac);
    const double length = norm(normal);
    area += length;
    bounds_.push_back({points[a], unit(normal), std::sqrt(std::max(norm_squared(ab), norm_squared(ac)))});
  }
  const double edge = std::sqrt(area / static_cast<double>(triangles.size()));
  width_ = std::max(edge, std::max({extent.x, extent.y, extent.z}) / most_cells);
  auto count = [&](double length) { return static_cast<std::int64_t>(length / width_) + 1; };
  counts_ = {count(extent.x), count(extent.y), count(extent.z)};
  offsets_.resize(static_cast<std::size_t>(counts_.x * counts_.y * counts_.z) + 1);
  for (const Triangle& t : triangles) for_each_cell(t, [&](std::int64_t cell) { ++offsets_[cell + 1]; });
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  members_.resize(offsets_.back());
  std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for_each_cell(triangles[i], [&](std::int64_t cell) { members_[next[cell]++] = static_cast<std::int32_t>(i); });
}

// Clamped to the grid.
DistanceIndex::Cell DistanceIndex::cell_of(const Vec3& p) const {
  auto number = [&](double x, double low, std::int64_t count) {
    return static_cast<std::int64_t>(std::clamp(std::floor((x - low) / width_), 0.0, static_cast<double>(count - 1)));
  };
  return {number(p.x, low_.x, counts_.x), number(p.y, low_.y, counts_.y), number(p.z, low_.z, counts_.z)};
}

template <class Visit>
void DistanceIndex::for_each_cell(const Triangle& t, Visit&& visit) const {
  const auto cells_in = [&](const geometry::Box& box, auto&& take) {
    const Cell low = cell_of(box.low), high = cell_of(box.high);
    for (std::int64_t z = low.z; z <= high.z; ++z)
      for (std::int64_t y = low.y; y <= high.y; ++y)
        for (std::int64_t x = low.x; x <= high.x; ++x) take(number_of({x, y, z}));
  };
  geometry::TriangleSlices(points_[t[0]], points_[t[1]], points_[t[2]], width_).for_each_cell(cells_in, visit);
}

double DistanceIndex::distance(const Vec3& p, std::int32_t& nearest, double enough) const {
  constexpr double furthest = std::numeric_limits<double>::max();
  Search search{nearest, furthest, furthest, enough * enough};
  if (nearest != no_index) {
    const auto [a, b, c] = triangles_[nearest];
    search.take(nearest, geometry::TriangleDistance(points_[a], points_[b], points_[c]).squared(p));
  }
  const Cell centre = cell_of(p);
  const std::int64_t rings = std::max({counts_.x, counts_.y, counts_.z});
  const double margin = margin_in(centre, p);
  for (std::int64_t ring = 0; ring < rings && !search.is_done(); ++ring) {
    look_in_shell(p, centre, ring, search);
    // Anything in a later ring is at least this far away. The cells of the next ring are looked at one by one.
    const double reach = static_cast<double>(ring) * width_ + margin;
    if (search.best <= reach * reach) break;
  }
  nearest = search.nearest;
  return search.distance;
}

// The distance of a point from the sides of its cell; 0 outside.
double DistanceIndex::margin_in(const Cell& cell, const Vec3& p) const {
  auto along = [&](double x, double low, std::int64_t number) {
    const double from_low = x - (low + static_cast<double>(number) * width_);
    return std::min(from_low, width_ - from_low);
  };
  return std::max(0.0, std::min({along(p.x, low_.x, cell.x), along(p.y, low_.y, cell.y), along(p.z, low_.z, cell.z)}));
}

void DistanceIndex::look_in_shell(const Vec3& p, const Cell& centre, std::int64_t ring, Search& search) const {
  for (std::int64_t z = std::max<std::int64_t>(centre.z - ring, 0); z <= std::min(centre.z + ring, counts_.z - 1); ++z)
    for (std::int64_t y = std::max<std::int64_t>(centre.y - ring, 0); y <= std::min(centre.y + ring, counts_.y - 1);
         ++y) {
      const bool on_side = std::max(std::abs(z - centre.z), std::abs(y - centre.y)) == ring;
      const std::int64_t step = on_side || ring == 0 ? 1 : 2 * ring;
      for (std::int64_t x = centre.x - ring; x <= centre.x + ring; x += step)
        if (x >= 0 && x < counts_.x && squared_to_box(p, {x, y, z}) < search.best) look_in_cell(p, {x, y, z}, search);
    }
}

double DistanceIndex::squared_to_box(const Vec3& p, const Cell& cell) const {
  auto outside = [&](double x, double low, std::int64_t number) {
    const double from_low = x - (low + static_cast<double>(number) * width_);
    return std::max({0.0, -from_low, from_low - width_});
  };
  return norm_squared(Vec3{outside(p.x, low_.x, cell.x), outside(p.y, low_.y, cell.y), outside(p.z, low_.z, cell.z)});
}

void DistanceIndex::look_in_cell(const Vec3& p, const Cell& cell, Search& search) const {
  constexpr double room = 1 + 1e-9;  // for rounding
  const std::int64_t number = number_of(cell);
  for (std::int64_t i = offsets_[number]; i < offsets_[number + 1] && !search.is_done(); ++i) {
    const auto& [corner, normal, radius] = bounds_[members_[i]];
    const Vec3 way = p - corner;
    const double height = dot(way, normal), reach = room * (search.distance + radius);
    if (height * height >= search.best || norm_squared(way) > reach * reach) continue;
    const auto [a, b, c] = triangles_[members_[i]];
    const double squared = geometry::TriangleDistance(points_[a], points_[b], points_[c]).squared(p);
    if (squared < search.best) search.take(members_[i], squared);
  }
}

SurfaceDistance one_sided_distance(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                   const DistanceIndex& other, const sizing::SizeField& spacing,
                                   const sizing::SizeField& limit) {
  SurfaceDistance result;
  const SurfaceSampler sampler(points, triangles, spacing);
  const auto count = static_cast<std::int64_t>(triangles.size());
  // A distance that is neither the greatest nor beyond the limit need not be exact. A few triangles first tell how
  // great the greatest is at least; most of the others then need no search.
  parallel_in_order((count + triangles_per_probe - 1) / triangles_per_probe, triangles_per_block,
                    [&](std::int64_t begin, std::int64_t end) {
                      double greatest = 0;
                      std::int32_t nearest = no_index;
                      for (std::int64_t i = begin; i < end; ++i)
                        sampler.for_each_sample(i * triangles_per_probe, [&](const Vec3& p) {
                          greatest = std::max(greatest, other.distance(p, nearest, greatest));
                        });
                      return greatest;
                    },
                    [&](double greatest) { result.greatest = std::max(result.greatest, greatest); });
  const double known = result.greatest;
  parallel_in_order(
      count, triangles_per_block,
      [&](std::int64_t begin, std::int64_t end) {
        SurfaceDistance part{known, {}};
        std::int32_t nearest = no_index;  // of the last sample, beside which the next one lies
        for (std::int64_t i = begin; i < end; ++i) {
          sampler.for_each_sample(i, [&](const Vec3& p) {
            const double distance = other.distance(p, nearest, std::min(part.greatest, limit.least()));
            part.greatest = std::max(part.greatest, distance);
            if (!limit.is_at_least(distance, p)) part.beyond.push_back(p);
          });
        }
        return part;
      },
      [&](SurfaceDistance&& part) {
        result.greatest = std::max(result.greatest, part.greatest);
        result.beyond.insert(result.beyond.end(), part.beyond.begin(), part.beyond.end());
      });
  return result;
}

}  // namespace hexpipe::tetmesh::surface
