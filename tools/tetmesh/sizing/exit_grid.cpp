#include "tools/tetmesh/sizing/exit_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/tetmesh/geometry/triangle_boxes.hpp"

namespace hexpipe::tetmesh::sizing {
namespace {

// Classes of normals fit into 64 bits. Rays are told apart more finely, so that the normals at a ray's start, and those
// in the classes beside them, are not taken for normals that it may meet from behind.
constexpr int parts_of_normals = 3, parts_of_rays = 9;
constexpr double cells_in_reach = 2;
// The most cells along each axis, so that a short reach does not fill the memory: 16 MB.
constexpr double most_cells = 128;
// Angles are known to this many radians, and places to this many reaches.
constexpr double room = 1e-6;
// The normal of a triangle with a smaller height, in lengths of its longest side, counts as unknown.
constexpr double least_height = 1e-5;

}  // namespace

int DirectionClasses::of(const Vec3& direction) const {
  int axis = 0;
  for (int other = 1; other < 3; ++other)
    if (std::abs(direction[other]) > std::abs(direction[axis])) axis = other;
  const double along = std::abs(direction[axis]);
  const auto part = [&](double across) {
    return std::clamp(static_cast<int>((across / along + 1) / 2 * parts_), 0, parts_ - 1);
  };
  const int side = 2 * axis + (direction[axis] < 0 ? 1 : 0);
  return (side * parts_ + part(direction[(axis + 1) % 3])) * parts_ + part(direction[(axis + 2) % 3]);
}

DirectionClasses::Cone DirectionClasses::cone_of(int number) const {
  const int second = number % parts_, first = number / parts_ % parts_, side = number / parts_ / parts_;
  const auto towards = [&](double one, double other) {
    std::array<double, 3> at{};
    at[side / 2] = side % 2 == 0 ? 1 : -1;
    at[(side / 2 + 1) % 3] = 2 * one / parts_ - 1;
    at[(side / 2 + 2) % 3] = 2 * other / parts_ - 1;
    return unit(Vec3{at[0], at[1], at[2]});
  };
  Cone cone{towards(first + 0.5, second + 0.5), 0};
  for (const int i : {0, 1})
    for (const int j : {0, 1})
      cone.angle = std::max(cone.angle, angle_between(cone.axis, towards(first + i, second + j)));
  return cone;
}

ExitGrid::ExitGrid(std::span<const Vec3> points, std::span<const Triangle> triangles, double reach)
    : of_normals_(parts_of_normals), of_rays_(parts_of_rays), reach_(reach) {
  std::vector<DirectionClasses::Cone> cones_of_normals;
  for (int normal = 0; normal < of_normals_.count(); ++normal) cones_of_normals.push_back(of_normals_.cone_of(normal));
  for (int ray = 0; ray < of_rays_.count(); ++ray) {
    const auto [direction, most_off] = of_rays_.cone_of(ray);
    Classes from_behind = 0;
    for (int normal = 0; normal < of_normals_.count(); ++normal) {
      const auto& [axis, angle] = cones_of_normals[normal];
      if (angle_between(direction, axis) <= std::numbers::pi / 2 + most_off + angle + room)
        from_behind |= Classes{1} << normal;
    }
    from_behind_.push_back(from_behind);
  }
  const geometry::Box box = geometry::Box::around(points);
  const Vec3 extent = box.high - box.low;
  low_ = box.low;
  width_ = std::max(reach / cells_in_reach, std::max({extent.x, extent.y, extent.z}) / most_cells);
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    counts_[axis] = static_cast<std::int64_t>(extent[axis] / width_) + 1;
    count *= static_cast<std::size_t>(counts_[axis]);
  }
  normals_.resize(count);
  for (const auto& [i, j, k] : triangles) {
    const Vec3 &a = points[i], &b = points[j], &c = points[k];
    const Classes classes = classes_of(a, b, c);
    geometry::TriangleSlices(a, b, c, width_).for_each_box([&](const geometry::Box& slice) {
      for_each_in(cells_around(slice.low, slice.high), [&](std::size_t cell) {
        normals_[cell] |= classes;
        return true;
      });
    });
  }
}

ExitGrid::Classes ExitGrid::classes_of(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const Vec3 normal = cross(b - a, c - a);
  const double longest = std::max({norm_squared(b - a), norm_squared(c - b), norm_squared(a - c)});
  if (!(norm(normal) > least_height * longest)) return ~Classes{0};
  return Classes{1} << of_normals_.of(normal);
}

ExitGrid::Cells ExitGrid::cells_around(const Vec3& low, const Vec3& high) const {
  Cells cells{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto number = [&](double x) {
      return std::clamp(static_cast<std::int64_t>(std::floor((x - low_[axis]) / width_)), std::int64_t{0},
                        counts_[axis] - 1);
    };
    cells.low[axis] = number(low[axis] - room * reach_);
    cells.high[axis] = number(high[axis] + room * reach_);
  }
  return cells;
}

// Stops when visit(cell) returns false.
template <class Visit>
void ExitGrid::for_each_in(const Cells& cells, Visit&& visit) const {
  for (std::int64_t z = cells.low[2]; z <= cells.high[2]; ++z)
    for (std::int64_t y = cells.low[1]; y <= cells.high[1]; ++y)
      for (std::int64_t x = cells.low[0]; x <= cells.high[0]; ++x)
        if (!visit(static_cast<std::size_t>((z * counts_[1] + y) * counts_[0] + x))) return;
}

bool ExitGrid::may_leave(const Vec3& from, const Vec3& direction) const {
  const Vec3 to = from + reach_ * direction;
  const Classes from_behind = from_behind_[of_rays_.of(direction)];
  bool found = false;
  const Cells cells = cells_around({std::min(from.x, to.x), std::min(from.y, to.y), std::min(from.z, to.z)},
                                   {std::max(from.x, to.x), std::max(from.y, to.y), std::max(from.z, to.z)});
  for_each_in(cells, [&](std::size_t cell) {
    found = (normals_[cell] & from_behind) != 0;
    return !found;
  });
  return found;
}

}  // namespace hexpipe::tetmesh::sizing
