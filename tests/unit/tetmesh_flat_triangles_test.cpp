#include "tools/tetmesh/solid/flat_triangles.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/geometry/half_edges.hpp"

namespace hexpipe {
using namespace tetmesh::solid;
namespace {

using testing::Facet;
using testing::Facets;

// A cube with three flat triangles on the diagonal of its top, as they are around the tip of a cone.
Surface cube_with_flat_triangles() {
  const Vec3 p{0, 0, 4}, q{4, 4, 4}, r{4, 0, 4}, s{0, 4, 4};
  Facets facets = testing::box({0, 0, 0}, {4, 4, 4});
  std::erase_if(facets, [](const Facet& f) { return f[0].z + f[1].z + f[2].z == 12; });
  const Vec3 m[] = {{1, 1, 4 + 1e-14}, {2, 2 + 1e-14, 4}, {3, 3, 4}};
  facets.insert(facets.end(), {Facet{p, r, q}, Facet{p, q, m[2]}, Facet{p, m[2], m[1]}, Facet{p, m[1], m[0]},
                               Facet{p, m[0], s}, Facet{m[0], m[1], s}, Facet{m[1], m[2], s}, Facet{m[2], q, s}});
  return testing::surface_of(facets);
}

double least_area(const Surface& surface) {
  double least = 1e9;
  for (const auto& [a, b, c] : surface.triangles)
    least =
        std::min(least, norm(cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a])) / 2);
  return least;
}

TEST(FlatTriangles, CutWhatIsBeyondTheirLongestEdge) {
  Surface surface = cube_with_flat_triangles();
  const auto tags = surface.tags;
  const std::size_t count = surface.triangles.size();
  ASSERT_LT(least_area(surface), 1e-9);
  EXPECT_EQ(flip_flat_triangles(surface), 3u);
  EXPECT_GT(least_area(surface), 1.9);
  EXPECT_EQ(surface.triangles.size(), count);
  EXPECT_EQ(surface.tags, tags);
  EXPECT_NO_THROW(tetmesh::geometry::find_twins(surface.points.size(), surface.triangles));
  EXPECT_NEAR(find_shells(surface, ShellRule::oriented).volume(), 64, 1e-9);
  EXPECT_EQ(flip_flat_triangles(surface), 0u);
}

TEST(FlatTriangles, StayAtCurvesAndWhereTagsMeet) {
  for (const bool has_curve : {true, false}) {
    Surface surface = cube_with_flat_triangles();
    std::size_t beyond = 0;  // the triangle with the whole diagonal and an area
    while (std::abs(dot(surface.points[surface.triangles[beyond][1]], Vec3{1, -1, 0}) - 4) > 1e-9 ||
           surface.points[surface.triangles[beyond][0]].z < 3 || surface.points[surface.triangles[beyond][2]].z < 3)
      ++beyond;
    const auto [p, r, q] = surface.triangles[beyond];
    if (has_curve)
      surface.curves.push_back({q, p});
    else
      surface.tags[beyond] = 7;
    const auto before = surface.triangles;
    EXPECT_EQ(flip_flat_triangles(surface), 0u);
    EXPECT_EQ(surface.triangles, before);
  }
}

// Two corners that are nearly one: the triangle has no middle corner.
TEST(FlatTriangles, NeedlesStay) {
  Surface surface = cube_with_flat_triangles();
  for (Vec3& p : surface.points)
    if (p.z > 3.9 && p.x > 0.5 && p.x < 3.5) p = {4 - (4 - p.x) * 2e-5, 4 - (4 - p.y) * 2e-5, 4};
  EXPECT_EQ(flip_flat_triangles(surface), 0u);
}

}  // namespace
}  // namespace hexpipe
