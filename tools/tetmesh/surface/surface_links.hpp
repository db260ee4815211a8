#pragma once
// How the triangles of a surface see their neighbours along a cross field.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "tools/tetmesh/fields/curl_correction.hpp"
#include "tools/tetmesh/fields/periodic_link.hpp"
#include "tools/tetmesh/surface/bend_stretch.hpp"
#include "tools/tetmesh/surface/cross_field.hpp"

namespace hexpipe::tetmesh::surface {

// Between the centres of triangles, along their two directions. Distances across bends count as longer, and all are
// corrected.
struct SurfaceLink : fields::PeriodicLink<2> {
  std::array<double, 2> way{};  // the distance before the correction

  // Matches the directions as they are seen here to those of the neighbour. Returns their mean cosine.
  double match(const std::array<Vec3, 2>& seen, const std::array<Vec3, 2>& there);
  // The neighbour's direction that was matched to k, reversed if need be.
  Vec3 matched(std::size_t k, const std::array<Vec3, 2>& there) const {
    return flipped[k] ? -there[axis[k]] : there[axis[k]];
  }
  // The same link, seen from the neighbour.
  SurfaceLink reversed(std::int32_t from) const;
};

// The weight of a link, by the mean cosine of the directions that it matches.
inline double trust_in_match(double cosine) {
  return std::max(0.0, 4 * cosine - 3);
}

struct SurfaceLinks {
  SurfaceLinks(const FieldSurface& on, const CrossField& along);

  const FieldSurface& surface;
  const CrossField& field;
  BendStretch stretch;
  std::vector<SurfaceLink> of;  // from each half-edge's triangle to the one beyond it; without a neighbour at a feature

  // From a triangle over its three half-edges.
  std::span<const SurfaceLink> at(std::int32_t triangle) const {
    return std::span(of).subspan(3 * static_cast<std::size_t>(triangle), 3);
  }
  // Calls body(h) for one half-edge of each pair with links.
  template <class Body>
  void for_each_pair(Body&& body) const {
    for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(of.size()); ++h)
      if (of[h].neighbour != no_index && h < surface.twins[h]) body(h);
  }
  // The same for change(h, its link), which changes the distances of a link; those of the link back follow.
  template <class Change>
  void change_distances(Change&& change) {
    for_each_pair([&](geometry::HalfEdge h) {
      change(h, of[h]);
      of[surface.twins[h]] = of[h].reversed(geometry::triangle_of(h));
    });
  }
  // Distances are numbered by these half-edges and the directions of their triangles.
  static std::int32_t number_of(geometry::HalfEdge h, std::size_t axis) {
    return 2 * h + static_cast<std::int32_t>(axis);
  }
};

// A direction of a triangle that is followed from one triangle to the next.
struct FollowedAxis {
  std::size_t axis;
  bool flipped = false;

  // The triangle's direction that is nearest to the given one.
  static FollowedAxis nearest(const SurfaceLinks& links, std::int32_t triangle, const Vec3& direction) {
    const auto axes = links.field.axes(links.surface, triangle);
    const std::size_t axis = std::abs(dot(axes[0], direction)) > std::abs(dot(axes[1], direction)) ? 0 : 1;
    return {axis, dot(axes[axis], direction) < 0};
  }
  Vec3 in(const SurfaceLinks& links, std::int32_t triangle) const {
    const Vec3 along = links.field.axes(links.surface, triangle)[axis];
    return flipped ? -along : along;
  }
  // Continues across a half-edge with a link. Returns what that adds to the coordinate.
  fields::LoopStep cross(const SurfaceLinks& links, geometry::HalfEdge h);
};

}  // namespace hexpipe::tetmesh::surface
