// Halves boxes across their longest side until a box is at most three sizes wide, or lies on one side of the surface
// with nearly the same size everywhere. Then its centre tells what is in it.

#include "tools/tetmesh/volume/estimates.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/run/error.hpp"
#include "tools/tetmesh/sizing/sizing.hpp"
#include "tools/tetmesh/solid/surface_clearance.hpp"

namespace hexpipe::tetmesh::volume {
namespace {

constexpr double widest = 3;  // in sizes
// Sizes in a box may be less than the size at its centre by this factor.
constexpr double most_difference = 0.6;
// Against the box around the model; no lattice is finer (graded_lattice.cpp).
constexpr double narrowest = 1.0 / (1 << 20);
// The estimate is at most three times the number of points.
constexpr double certain_excess = 4;

double volume_of(const geometry::Box& box) {
  const Vec3 extent = box.high - box.low;
  return extent.x * extent.y * extent.z;
}

double longest_side(const geometry::Box& box) {
  return (box.high - box.low)[box.longest_axis()];
}

void add_halves(const geometry::Box& box, std::vector<geometry::Box>& boxes) {
  const int axis = box.longest_axis();
  const double middle = box.centre()[axis];
  const auto with = [&](const Vec3& corner) {
    return Vec3{axis == 0 ? middle : corner.x, axis == 1 ? middle : corner.y, axis == 2 ? middle : corner.z};
  };
  boxes.push_back({box.low, with(box.high)});
  boxes.push_back({with(box.low), box.high});
}

}  // namespace

double points_inside(const solid::Surface& surface, const sizing::SizeField& size, double clearance, double enough) {
  const solid::SurfaceClearance clear(surface);
  std::vector<geometry::Box> boxes{geometry::Box::around(surface.points)};
  const double least_side = narrowest * longest_side(boxes.front());
  double sum = 0;
  while (!boxes.empty() && sum <= enough) {
    const geometry::Box box = boxes.back();
    boxes.pop_back();
    const Vec3 centre = box.centre();
    const double here = size.at(centre), side = longest_side(box), radius = norm(box.high - box.low) / 2;
    const bool on_one_side = clear.is_clear(centre, radius), inside = clear.is_inside(centre);
    if (on_one_side && !inside) continue;
    const bool is_wide = side > widest * here;
    const bool is_even = here - size.least_near(here, radius) < most_difference * here;
    if (is_wide && side > least_side && !(on_one_side && is_even))
      add_halves(box, boxes);
    else if (inside && clear.is_clear(centre, clearance * here))
      sum += is_wide && !is_even ? 1 : volume_of(box) / (here * here * here);
  }
  return sum;
}

void check_point_count(const solid::Surface& surface, double size, double most) {
  const double expected = sizing::points_expected(surface, size);
  if (expected > most)
    throw DataError::at(surface.name,
                        "expected a size that makes at most {:g} points inside (see --most-points), found {:g}, which "
                        "makes about {:.3g}",
                        most, size, expected);
}

void check_point_count(const solid::Surface& surface, const sizing::SizeField& size, double clearance, double most) {
  const double far_too_many = certain_excess * most;
  if (!size.is_uniform() && points_inside(surface, size, clearance, far_too_many) > far_too_many)
    throw DataError::at(surface.name,
                        "expected sizes that make at most {:g} points inside (see --most-points), found {:g} to {:g}, "
                        "which make more than {:g}",
                        most, size.least(), size.greatest(), far_too_many);
}

}  // namespace hexpipe::tetmesh::volume
