#include "tools/tetmesh/surface/feature_paths.hpp"

#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

constexpr std::size_t most_in_strip = 1000;

// The distance in a triangle from one place to another, along a direction, in sizes.
double length_in(const SurfaceLinks& links, std::int32_t triangle, const Vec3& direction, const Vec3& from,
                 const Vec3& to) {
  return links.stretch.in_direction(triangle, direction) * dot(direction, to - from) / links.surface.sizes[triangle];
}

}  // namespace

std::optional<NarrowStrip> narrow_strip(const SurfaceLinks& links, geometry::HalfEdge from, double widest) {
  const FieldSurface& surface = links.surface;
  SurfacePoint point{surface.points[geometry::start_of(surface.triangles, from)] + 0.5 * surface.edge_vector(from),
                     geometry::triangle_of(from)};
  const Vec3& inward = surface.inward(from);
  FollowedAxis followed = FollowedAxis::nearest(links, point.triangle, inward);
  Vec3 direction = followed.in(links, point.triangle), straight = direction;
  if (dot(direction, inward) < aligned_cosine) return std::nullopt;
  NarrowStrip strip{};
  strip.before = length_in(links, point.triangle, direction, point.position, surface.centres[point.triangle]);
  for (double length = 0; length < widest;) {
    const TriangleExit exit = exit_of(surface, point, straight);
    const Vec3 end = point.position + exit.length * straight;
    length += length_in(links, point.triangle, direction, point.position, end);
    if (surface.feature[exit.edge]) {
      if (-dot(direction, surface.inward(exit.edge)) < aligned_cosine || length > widest) return std::nullopt;
      strip.after = length_in(links, point.triangle, direction, surface.centres[point.triangle], end);
      strip.width = length;
      return strip;
    }
    if (links.of[exit.edge].weight <= 0 || strip.across.size() == most_in_strip) return std::nullopt;
    strip.across.push_back(followed.cross(links, exit.edge));
    straight = unfolded_beyond(surface, exit.edge, straight);
    point = {end, geometry::triangle_of(surface.twins[exit.edge])};
    direction = followed.in(links, point.triangle);
    if (dot(direction, straight) < aligned_cosine) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace hexpipe::tetmesh::surface
