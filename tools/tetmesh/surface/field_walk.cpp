#include "tools/tetmesh/surface/field_walk.hpp"

#include <algorithm>
#include <limits>

namespace hexpipe::tetmesh::surface {
namespace {

// A walk that circles around a vertex without getting on is given up after this many triangles.
constexpr int most_walked = 10'000;
// A direction of length 1 must advance by this much from the edge through which a triangle was entered.
constexpr double least_advance = 1e-3;

}  // namespace

Vec3 FieldWalker::nearest_direction(std::int32_t triangle, const Vec3& direction) const {
  const auto [x, y] = field_.axes(surface_, triangle);
  const double along_x = dot(direction, x), along_y = dot(direction, y);
  if (std::abs(along_x) >= std::abs(along_y)) return along_x >= 0 ? x : -x;
  return along_y >= 0 ? y : -y;
}

TriangleExit exit_of(const FieldSurface& surface, const SurfacePoint& point, const Vec3& direction) {
  TriangleExit exit{3 * point.triangle, std::numeric_limits<double>::max()};
  for (geometry::HalfEdge h = 3 * point.triangle; h < 3 * point.triangle + 3; ++h) {
    const Vec3 inward = surface.inward(h);
    const double advance = dot(direction, inward);
    if (advance >= -1e-12) continue;
    const double distance =
        std::max(0.0, dot(point.position - surface.points[geometry::start_of(surface.triangles, h)], inward));
    if (distance / -advance < exit.length) exit = {h, distance / -advance};
  }
  return exit;
}

Vec3 unfolded_beyond(const FieldSurface& surface, geometry::HalfEdge edge, const Vec3& direction) {
  const Vec3& along = surface.along(edge);
  return dot(direction, along) * along - dot(direction, surface.inward(edge)) * surface.inward(surface.twins[edge]);
}

Vec3 FieldWalker::field_beyond(geometry::HalfEdge edge, const Vec3& direction) const {
  const geometry::HalfEdge twin = surface_.twins[edge];
  const Vec3 unfolded = unfolded_beyond(surface_, edge, direction);
  const Vec3 in_field = nearest_direction(geometry::triangle_of(twin), unfolded);
  return dot(in_field, surface_.inward(twin)) > least_advance ? in_field : unfolded;
}

WalkEnd FieldWalker::go(const SurfacePoint& start, const Vec3& direction, double length, bool along_field) const {
  WalkEnd end{start, direction};
  Vec3& heading = end.heading;
  for (int i = 0; i < most_walked; ++i) {
    const TriangleExit exit = exit_of(surface_, end.point, heading);
    const double step = std::min(exit.length, length - end.length);
    end.point.position += step * heading;
    end.length += step;
    if (exit.length > step || end.length >= length) break;
    if (surface_.feature[exit.edge]) {
      end.at_feature = true;
      break;
    }
    heading = along_field ? field_beyond(exit.edge, heading) : unfolded_beyond(surface_, exit.edge, heading);
    end.point.triangle = geometry::triangle_of(surface_.twins[exit.edge]);
  }
  return end;
}

}  // namespace hexpipe::tetmesh::surface
