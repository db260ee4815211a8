// Apart from the others because it includes CGAL's polygon mesh processing, which takes long to compile and is under
// the GPL.

#include "tools/tetmesh/solid/repair_steps.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>

#include <iterator>

namespace hexpipe::tetmesh::solid {

std::vector<Triangle> fill_hole(std::span<const Vec3> points, std::span<const HoleEdge> border) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point> corners, across;
  for (const HoleEdge& edge : border) {
    const Vec3 &corner = points[edge.start], &third = points[edge.across];
    corners.emplace_back(corner.x, corner.y, corner.z);
    across.emplace_back(third.x, third.y, third.z);
  }
  std::vector<CGAL::Triple<int, int, int>> found;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(corners, across, std::back_inserter(found));
  std::vector<Triangle> triangles;
  triangles.reserve(found.size());
  for (const auto& [a, b, c] : found) triangles.push_back({border[a].start, border[b].start, border[c].start});
  return triangles;
}

}  // namespace hexpipe::tetmesh::solid
