#include "tools/tetmesh/surface/feature_paths.hpp"

#include <cmath>

namespace hexpipe::tetmesh::surface {

std::optional<FeatureFan> feature_fan(const SurfaceLinks& links, geometry::HalfEdge first) {
  const FieldSurface& surface = links.surface;
  const std::int32_t f = geometry::triangle_of(first);
  const Vec3& vertex = surface.points[geometry::start_of(surface.triangles, first)];
  const Vec3 edge = surface.edge_vector(first);
  FollowedAxis along = FollowedAxis::nearest(links, f, edge), across{1 - along.axis};
  across.flipped = dot(across.in(links, f), surface.inward(first)) < 0;
  const Vec3 onward = along.in(links, f), inward = across.in(links, f);
  if (dot(onward, unit(edge)) < aligned_cosine) return std::nullopt;

  FeatureFan fan{};
  fan.first = first;
  fan.first_ahead = dot(onward, vertex + 0.5 * edge - surface.centres[f]) / links.surface.sizes[f];
  fan.last = geometry::previous_in_triangle(first);
  for (; !surface.feature[fan.last]; fan.last = geometry::previous_in_triangle(surface.twins[fan.last])) {
    if (links.of[fan.last].weight <= 0) return std::nullopt;
    fan.along.push_back(along.cross(links, fan.last));
    fan.across.push_back(across.cross(links, fan.last));
  }
  const std::int32_t g = geometry::triangle_of(fan.last);
  const Vec3 last_edge = surface.edge_vector(fan.last), last_onward = along.in(links, g);
  if (dot(last_onward, unit(last_edge)) < aligned_cosine) return std::nullopt;
  fan.last_ahead = dot(last_onward, vertex - 0.5 * last_edge - surface.centres[g]) / links.surface.sizes[g];
  fan.apart = dot(inward, surface.centres[f] - vertex) / links.surface.sizes[f] -
              dot(across.in(links, g), surface.centres[g] - vertex) / links.surface.sizes[g];
  return fan;
}

}  // namespace hexpipe::tetmesh::surface
