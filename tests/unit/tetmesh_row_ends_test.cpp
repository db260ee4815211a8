#include "tools/tetmesh/surface/row_ends.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"

namespace hexpipe {
using namespace tetmesh::geometry;
using namespace tetmesh::surface;
namespace {

using testing::box;
using testing::surface_of;

FeatureMesh refined_box() {
  FeatureMesh mesh(surface_of(box({0, 0, 0}, {6, 6, 6})), 40);
  refine_surface(mesh, 1, 1e-6);
  return mesh;
}

// A box on which no row ends.
struct Rows {
  FieldSurface surface{refined_box(), 1};
  CrossField field = cross_field(surface);
  SurfaceLinks links{surface, field};
  RowJumps jumps = row_jumps(links, coordinates());

  std::int32_t ends() const {
    const auto at_vertices = row_ends(links, jumps);
    return std::accumulate(at_vertices.begin(), at_vertices.end(), 0);
  }
  // Between two vertices within a face.
  HalfEdge inner_edge() const {
    std::vector<bool> on_feature(surface.points.size());
    for (HalfEdge h = 0; h < static_cast<HalfEdge>(surface.twins.size()); ++h)
      if (surface.feature[h]) on_feature[start_of(surface.triangles, h)] = true;
    HalfEdge h = 0;
    while (on_feature[start_of(surface.triangles, h)] || on_feature[end_of(surface.triangles, h)]) ++h;
    return h;
  }
  // One row more across an edge: one ends at each of its vertices, in opposite senses.
  void add_row(HalfEdge h, std::size_t axis) {
    const SurfaceLink& link = links.of[h];
    ++jumps[h][axis];
    jumps[surface.twins[h]][link.axis[axis]] += link.flipped[axis] ? 1 : -1;
  }

 private:
  RowCoordinates coordinates() const {
    RowCoordinates result;
    for (std::int32_t f = 0; f < static_cast<std::int32_t>(surface.triangles.size()); ++f) {
      const auto axes = field.axes(surface, f);
      auto& here = result.emplace_back();
      for (std::size_t k = 0; k < 2; ++k) {
        const double along = dot(axes[k], surface.centres[f]);
        here[k] = along - std::round(along);
      }
    }
    return result;
  }
};

TEST(RowEnds, AreNoneOnABox) {
  EXPECT_EQ(Rows().ends(), 0);
}

TEST(RowEnds, OfOneRowAreJoinedWithinReach) {
  for (const std::size_t axis : {0u, 1u}) {
    Rows rows;
    const RowJumps whole = rows.jumps;
    rows.add_row(rows.inner_edge(), axis);
    EXPECT_EQ(rows.ends(), 2);
    const RowJumps broken = rows.jumps;
    join_row_ends(rows.links, 0.05, rows.jumps);
    EXPECT_EQ(rows.jumps, broken);
    join_row_ends(rows.links, 2, rows.jumps);
    EXPECT_EQ(rows.ends(), 0);
    EXPECT_EQ(rows.jumps, whole);
  }
}

// Along both directions at once, and twice along one.
TEST(RowEnds, OfSeveralRowsAreCountedAndJoined) {
  Rows rows;
  const HalfEdge h = rows.inner_edge();
  rows.add_row(h, 0);
  rows.add_row(h, 0);
  rows.add_row(h, 1);
  EXPECT_EQ(rows.ends(), 6);
  join_row_ends(rows.links, 2, rows.jumps);
  EXPECT_EQ(rows.ends(), 0);
}

}  // namespace
}  // namespace hexpipe
