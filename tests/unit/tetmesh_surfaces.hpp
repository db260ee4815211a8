#pragma once
// Surfaces as tetmesh takes them, from facets, and what tells the truth about them slowly.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "common/run/random.hpp"
#include "surface_samples.hpp"
#include "tools/tetmesh/geometry/triangle_distance.hpp"
#include "tools/tetmesh/solid/shells.hpp"
#include "tools/tetmesh/surface/surface_distance.hpp"
#include "tools/tetmesh/surface/surface_remesh.hpp"
#include "tools/tetmesh/tetgen/build_mesh.hpp"
#include "tools/tetmesh/tetgen/run_tetgen.hpp"

namespace hexpipe::testing {
using namespace tetmesh::solid;
using namespace tetmesh::tetgen;
using namespace tetmesh::geometry;
using namespace formats;

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

// Points inside a cube of n x n x n unit cells: the lattice's, each moved at random by up to `moved` along each axis.
inline std::vector<Vec3> lattice_in_cube(int n, double moved) {
  Random random(1);
  std::vector<Vec3> inside;
  for (int k = 1; k < n; ++k)
    for (int j = 1; j < n; ++j)
      for (int i = 1; i < n; ++i)
        inside.push_back(
            {i + moved * random.uniform(-1, 1), j + moved * random.uniform(-1, 1), k + moved * random.uniform(-1, 1)});
  return inside;
}

inline BuiltMesh mesh_of(const Surface& surface, std::span<const Vec3> inside) {
  return build_mesh(
      surface, inside,
      run_tetgen({.surface_points = surface.points, .triangles = surface.triangles, .interior_points = inside}, 60));
}

// Makes the triangles anew until they are as promised.
inline tetmesh::surface::RemeshResult remesh_surface(const Surface& surface,
                                                     const tetmesh::surface::RemeshOptions& options) {
  tetmesh::surface::SurfaceRemesher remesher(surface, options);
  while (remesher.make() && !remesher.judge()) {
  }
  return remesher.take();
}

// The greatest distance of a point of either surface from the other, at samples a hundredth apart.
inline double distance_between(const Surface& a, const Surface& b) {
  using namespace tetmesh::surface;
  const DistanceIndex of_a(a.points, a.triangles), of_b(b.points, b.triangles);
  return std::max(one_sided_distance(a.points, a.triangles, of_b, 0.01, 1).greatest,
                  one_sided_distance(b.points, b.triangles, of_a, 0.01, 1).greatest);
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
