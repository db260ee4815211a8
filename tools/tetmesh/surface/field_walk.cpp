#include "tools/tetmesh/surface/field_walk.hpp"

#include <algorithm>
#include <limits>

namespace hexpipe {
namespace {

// A walk that goes around a vertex without getting on is given up after so many triangles.
constexpr int most_triangles = 10'000;
// Of a direction of length 1, what it must advance from the edge through which a triangle was entered.
constexpr double least_advance = 1e-3;

}  // namespace

Vec3 FieldWalker::nearest_direction(std::int32_t triangle, const Vec3& direction) const {
  const auto [x, y] = field_.axes(surface_, triangle);
  const double along_x = dot(direction, x), along_y = dot(direction, y);
  if (std::abs(along_x) >= std::abs(along_y)) return along_x >= 0 ? x : -x;
  return along_y >= 0 ? y : -y;
}

FieldWalker::Exit FieldWalker::exit_of(const SurfacePoint& point, const Vec3& direction) const {
  Exit exit{3 * point.triangle, std::numeric_limits<double>::max()};
  for (HalfEdge h = 3 * point.triangle; h < 3 * point.triangle + 3; ++h) {
    const Vec3 inward = surface_.inward(h);
    const double advance = dot(direction, inward);
    if (advance >= -1e-12) continue;
    const double distance =
        std::max(0.0, dot(point.position - surface_.points[start_of(surface_.triangles, h)], inward));
    if (distance / -advance < exit.length) exit = {h, distance / -advance};
  }
  return exit;
}

Vec3 FieldWalker::direction_beyond(HalfEdge edge, const Vec3& direction, bool along_field) const {
  const HalfEdge twin = surface_.twins[edge];
  const Vec3 side = surface_.edge_vector(edge);
  const Vec3 along = unit(side), inward = surface_.inward(twin);
  const Vec3 unfolded = dot(direction, along) * along - dot(direction, surface_.inward(edge)) * inward;
  if (!along_field) return unfolded;
  const Vec3 in_field = nearest_direction(triangle_of(twin), unfolded);
  return dot(in_field, inward) > least_advance ? in_field : unfolded;
}

WalkEnd FieldWalker::go(const SurfacePoint& start, const Vec3& direction, double length, bool along_field) const {
  WalkEnd end{start, direction};
  Vec3& heading = end.heading;
  for (int i = 0; i < most_triangles; ++i) {
    const Exit exit = exit_of(end.point, heading);
    const double step = std::min(exit.length, length - end.length);
    end.point.position += step * heading;
    end.length += step;
    if (exit.length > step || end.length >= length) break;
    if (surface_.feature[exit.edge]) {
      end.at_feature = true;
      break;
    }
    heading = direction_beyond(exit.edge, heading, along_field);
    end.point.triangle = triangle_of(surface_.twins[exit.edge]);
  }
  return end;
}

}  // namespace hexpipe
