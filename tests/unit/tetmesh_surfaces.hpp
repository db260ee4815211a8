#pragma once
// Surfaces as tetmesh takes them, from facets, and what tells the truth about them slowly.

#include <algorithm>
#include <cmath>
#include <limits>

#include "surface_samples.hpp"
#include "tools/tetmesh/shells.hpp"
#include "tools/tetmesh/triangle_distance.hpp"

namespace hexpipe::testing {

inline Surface surface_of(const Facets& facets) {
  return find_shells(soup_of(facets), ShellRule::oriented);
}

// Gives a tag to the triangles whose centres are where it says.
template <class IsThere>
void tag_where(Surface& surface, std::int32_t tag, IsThere&& is_there) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    if (is_there((surface.points[a] + surface.points[b] + surface.points[c]) * (1.0 / 3))) surface.tags[t] = tag;
  }
}

// By a look at every triangle.
template <class TriangulatedSurface>
double naive_distance(const TriangulatedSurface& surface, const Vec3& p) {
  double least = std::numeric_limits<double>::max();
  for (const auto& [a, b, c] : surface.triangles)
    least = std::min(least, TriangleDistance(surface.points[a], surface.points[b], surface.points[c]).squared(p));
  return std::sqrt(least);
}

}  // namespace hexpipe::testing
