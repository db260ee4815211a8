#include "tools/tetmesh/volume/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/mesh/box_tree.hpp"
#include "common/run/error.hpp"
#include "tools/tetmesh/geometry/column_index.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

// Each takes a byte while points are sorted out.
constexpr double most_nodes = 1e9;

// The state of a lattice point. The surface does not pass between two neighbouring far points, because each is further
// from it than half their distance.
enum class Place : std::uint8_t { far, near, too_near, inside, outside };

class Lattice {
 public:
  Lattice(const solid::Surface& surface, const LatticeOptions& options) : surface_(surface), options_(options) {
    fit();
  }

  std::vector<Vec3> points_inside() {
    mark_distances();
    find_inside();
    return collect();
  }

 private:
  using Index = std::array<std::int64_t, 3>;

  void fit();
  Vec3 node(const Index& i) const;
  std::int64_t number_of(const Index& i) const { return (i[2] * counts_[1] + i[1]) * counts_[0] + i[0]; }
  Index index_of(std::int64_t number) const;
  void mark_distances();
  void mark_around(const Triangle& triangle);
  void find_inside();
  void flood(std::int64_t start, Place place);
  std::vector<Vec3> collect() const;

  const solid::Surface& surface_;
  const LatticeOptions& options_;
  Vec3 low_;  // of the bounding box; the first lattice point is one step inside
  std::array<double, 3> steps_{};
  Index counts_{};
  double clearance_ = 0, far_distance_ = 0;
  std::vector<Place> places_;
  std::vector<std::int64_t> queue_;
};

void Lattice::fit() {
  const auto [low, high] = Box::around(surface_.points);
  low_ = low;
  double nodes = 1;
  std::array<double, 3> counts{};
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = high[axis] - low[axis];
    const double steps = std::max(1.0, std::round(extent / options_.size));
    steps_[axis] = extent / steps;
    counts[axis] = steps - 1;
    nodes *= counts[axis];
  }
  if (nodes > most_nodes)
    throw DataError::at(
        surface_.name,
        "expected a size of which the bounding box holds at most {:g} lattice points, found {:g}, which makes {:.3g}",
        most_nodes, options_.size, nodes);
  for (int axis = 0; axis < 3; ++axis) counts_[axis] = static_cast<std::int64_t>(counts[axis]);
  places_.assign(static_cast<std::size_t>(nodes), Place::far);
  clearance_ = options_.clearance * options_.size;
  // Rounding must not let the flood through a wall that lies exactly halfway between two points.
  far_distance_ = (1 + 1e-9) * std::max({steps_[0], steps_[1], steps_[2]}) / 2;
}

Vec3 Lattice::node(const Index& i) const {
  return low_ + Vec3{static_cast<double>(i[0] + 1) * steps_[0], static_cast<double>(i[1] + 1) * steps_[1],
                     static_cast<double>(i[2] + 1) * steps_[2]};
}

Lattice::Index Lattice::index_of(std::int64_t number) const {
  return {number % counts_[0], number / counts_[0] % counts_[1], number / counts_[0] / counts_[1]};
}

void Lattice::mark_distances() {
  if (places_.empty()) return;
  for (const Triangle& triangle : surface_.triangles) mark_around(triangle);
}

// Walks the columns of lattice points along the axis that the triangle faces most; in each column only the points in
// the slab around the triangle's plane.
void Lattice::mark_around(const Triangle& triangle) {
  const Vec3 &a = surface_.points[triangle[0]], &b = surface_.points[triangle[1]], &c = surface_.points[triangle[2]];
  const geometry::TriangleDistance distance(a, b, c);
  const Vec3& normal = distance.normal();
  const double reach = std::max(clearance_, far_distance_);
  auto range_of = [&](double low, double high, int axis) {
    const double first = std::ceil((low - reach - low_[axis]) / steps_[axis]) - 1;
    const double last = std::floor((high + reach - low_[axis]) / steps_[axis]) - 1;
    const auto top = static_cast<double>(counts_[axis] - 1);
    return std::array{static_cast<std::int64_t>(std::clamp(first, 0.0, top + 1)),
                      static_cast<std::int64_t>(std::clamp(last, -1.0, top))};
  };
  auto bounds_of = [&](int axis) {
    return range_of(std::min({a[axis], b[axis], c[axis]}), std::max({a[axis], b[axis], c[axis]}), axis);
  };
  int up = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (std::abs(normal[axis]) > std::abs(normal[up])) up = axis;
  const int u = (up + 1) % 3, v = (up + 2) % 3;
  const auto range_u = bounds_of(u), range_v = bounds_of(v), range_up = bounds_of(up);
  const double slab = reach * (norm(normal) / std::abs(normal[up]) - 1);

  Index i{};
  for (i[v] = range_v[0]; i[v] <= range_v[1]; ++i[v]) {
    for (i[u] = range_u[0]; i[u] <= range_u[1]; ++i[u]) {
      i[up] = 0;
      const Vec3 from_corner = node(i) - a;
      const double height = a[up] - (from_corner[u] * normal[u] + from_corner[v] * normal[v]) / normal[up];
      const auto in_slab = range_of(height - slab, height + slab, up);
      for (i[up] = std::max(range_up[0], in_slab[0]); i[up] <= std::min(range_up[1], in_slab[1]); ++i[up]) {
        Place& place = places_[number_of(i)];
        if (place == Place::too_near) continue;
        const double squared = distance.squared(node(i));
        if (squared < clearance_ * clearance_)
          place = Place::too_near;
        else if (squared <= far_distance_ * far_distance_)
          place = Place::near;
      }
    }
  }
}

void Lattice::find_inside() {
  const geometry::ColumnIndex columns(surface_.points, surface_.triangles);
  for (std::size_t n = 0; n < places_.size(); ++n) {
    if (places_[n] != Place::far && places_[n] != Place::near) continue;
    const auto number = static_cast<std::int64_t>(n);
    const Place place =
        solid::is_in_material(surface_, columns, node(index_of(number))) ? Place::inside : Place::outside;
    if (places_[n] == Place::far) flood(number, place);
    places_[n] = place;
  }
}

// Gives `place` to all far points that far neighbours connect to the start.
void Lattice::flood(std::int64_t start, Place place) {
  const std::array<std::int64_t, 3> strides{1, counts_[0], counts_[0] * counts_[1]};
  queue_.assign(1, start);
  places_[start] = place;
  while (!queue_.empty()) {
    const std::int64_t number = queue_.back();
    queue_.pop_back();
    const Index i = index_of(number);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int direction : {-1, 1}) {
        if (i[axis] + direction < 0 || i[axis] + direction >= counts_[axis]) continue;
        const std::int64_t neighbour = number + direction * strides[axis];
        if (places_[neighbour] != Place::far) continue;
        places_[neighbour] = place;
        queue_.push_back(neighbour);
      }
    }
  }
}

std::vector<Vec3> Lattice::collect() const {
  std::vector<Vec3> points;
  const double reach = options_.jitter * options_.size;
  for (std::size_t n = 0; n < places_.size(); ++n) {
    if (places_[n] != Place::inside) continue;
    points.push_back(node(index_of(static_cast<std::int64_t>(n))) + jitter_of(n, reach, options_.seed));
  }
  return points;
}

}  // namespace

std::vector<Vec3> lattice_points(const solid::Surface& surface, const LatticeOptions& options) {
  if (options.axes == LatticeOptions{}.axes) return Lattice(surface, options).points_inside();
  const auto& [x, y, z] = options.axes;
  solid::Surface turned = surface;
  for (Vec3& p : turned.points) p = {dot(p, x), dot(p, y), dot(p, z)};
  std::vector<Vec3> points = Lattice(turned, options).points_inside();
  for (Vec3& p : points) p = p.x * x + p.y * y + p.z * z;
  return points;
}

}  // namespace hexpipe::tetmesh::volume
