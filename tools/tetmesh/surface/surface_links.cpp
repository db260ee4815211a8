#include "tools/tetmesh/surface/surface_links.hpp"

#include <algorithm>
#include <cmath>

#include "common/run/parallel.hpp"
#include "tools/tetmesh/surface/field_walk.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// From the triangle of h to the one beyond it, as both lie unfolded.
SurfaceLink make_link(const SurfaceLinks& links, geometry::HalfEdge h) {
  const FieldSurface& surface = links.surface;
  const geometry::HalfEdge twin = surface.twins[h];
  const std::int32_t f = geometry::triangle_of(h), g = geometry::triangle_of(twin);
  const auto here = links.field.axes(surface, f), there = links.field.axes(surface, g);
  const Vec3 side = surface.edge_vector(h);
  const Vec3 &inward = surface.inward(h), &beyond = surface.inward(twin);
  const Vec3 middle = surface.points[geometry::start_of(surface.triangles, h)] + 0.5 * side;
  const Vec3 from = surface.centres[f] - middle, to = surface.centres[g] - middle;
  SurfaceLink link;
  link.neighbour = g;
  std::array<Vec3, 2> unfolded;
  for (std::size_t k = 0; k < 2; ++k) unfolded[k] = unfolded_beyond(surface, h, here[k]);
  const double cosine = link.match(unfolded, there);
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 matched = link.matched(k, there);
    const double size = 0.5 * (surface.sizes[f] + surface.sizes[g]), before = dot(here[k], from),
                 after = dot(matched, to);
    link.way[k] = (before - after) / size;
    link.distance[k] =
        (links.stretch.in_direction(f, here[k]) * before - links.stretch.in_direction(g, matched) * after) / size;
  }
  const double across = dot(from, inward) + dot(to, beyond);
  link.weight = norm(side) / std::max(across, 1e-3 * norm(side)) * trust_in_match(cosine);
  return link;
}

}  // namespace

double SurfaceLink::match(const std::array<Vec3, 2>& seen, const std::array<Vec3, 2>& there) {
  const bool crossed = std::abs(dot(seen[0], there[1])) > std::abs(dot(seen[0], there[0]));
  axis = crossed ? std::array<std::uint8_t, 2>{1, 0} : std::array<std::uint8_t, 2>{0, 1};
  double sum = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double cosine = dot(seen[k], there[axis[k]]);
    flipped[k] = cosine < 0;
    sum += std::abs(cosine);
  }
  return sum / 2;
}

SurfaceLink SurfaceLink::reversed(std::int32_t from) const {
  SurfaceLink back{fields::PeriodicLink<2>::reversed(from)};
  for (std::size_t k = 0; k < 2; ++k) back.way[axis[k]] = flipped[k] ? way[k] : -way[k];
  return back;
}

SurfaceLinks::SurfaceLinks(const FieldSurface& on, const CrossField& along)
    : surface(on), field(along), stretch(bend_stretch(on, along)), of(on.twins.size()) {
  parallel_for(static_cast<std::int64_t>(of.size()), 1024, [&](std::int64_t i) {
    const auto h = static_cast<geometry::HalfEdge>(i), twin = on.twins[h];
    if (on.feature[h] || twin < h) return;
    of[h] = make_link(*this, h);
    of[twin] = of[h].reversed(geometry::triangle_of(h));
  });
}

fields::LoopStep FollowedAxis::cross(const SurfaceLinks& links, geometry::HalfEdge h) {
  const SurfaceLink& link = links.of[h];
  const geometry::HalfEdge twin = links.surface.twins[h];
  const std::size_t here = axis, there = link.axis[axis];
  const bool before = flipped, turned = flipped != link.flipped[axis];
  axis = there;
  flipped = turned;
  if (h < twin) return {SurfaceLinks::number_of(h, here), before};
  return {SurfaceLinks::number_of(twin, there), !turned};
}

}  // namespace hexpipe::tetmesh::surface
