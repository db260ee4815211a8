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

// By a look at every triangle.
template <class TriangulatedSurface>
double naive_distance(const TriangulatedSurface& surface, const Vec3& p) {
  double least = std::numeric_limits<double>::max();
  for (const auto& [a, b, c] : surface.triangles)
    least = std::min(least, TriangleDistance(surface.points[a], surface.points[b], surface.points[c]).squared(p));
  return std::sqrt(least);
}

}  // namespace hexpipe::testing
