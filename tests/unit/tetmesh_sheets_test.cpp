// Surfaces of bodies that touch: cut into pieces, and made anew.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/run/error.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/solid/sheets.hpp"
#include "tools/tetmesh/surface/feature_curves.hpp"
#include "tools/tetmesh/surface/opposite_sides.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"
#include "tools/tetmesh/surface/sheet_cut.hpp"
#include "tools/tetmesh/volume/field_nodes.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::solid;
using namespace tetmesh::surface;
using namespace tetmesh::geometry;
namespace {

using testing::box;
using testing::Facets;
using testing::joined;
using testing::mesh_of;
using testing::remesh_surface;
using testing::ring;
using testing::soup_of;

Surface sheets_of(const Facets& facets) {
  SurfaceSoup soup = soup_of(facets);
  find_sides(soup, ShellRule::oriented);
  return find_sheets(std::move(soup));
}

Facets boxes_with_common_face() {
  return joined(box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1}));
}

Facets boxes_with_common_edge() {
  return joined(box({0, 0, 0}, {1, 1, 1}), box({1, 1, 0}, {2, 2, 1}));
}

// A cup beside a cube: a body with a hole, unless the file says that there is the same on both sides.
TEST(Sheets, SidesThatTheFileTellsAreBelieved) {
  Facets cup = box({1, 1, 0}, {2, 2, 1});
  cup.erase(cup.begin(), cup.begin() + 2);
  SurfaceSoup soup = soup_of(joined(box({0, 0, 0}, {1, 1, 1}), cup)), told = soup;
  EXPECT_THROW(find_sides(soup, ShellRule::oriented), DataError);
  for (std::size_t t = 0; t < told.triangles.size(); ++t)
    told.sides.push_back(t < 12 ? std::array{1, 0} : std::array{0, 0});
  EXPECT_EQ(join_bodies(told).fins, 10u);
  EXPECT_EQ(told.triangles.size(), 12u);
}

TEST(Sheets, ABodyThatIsToldAndHasAHoleIsNoBaffle) {
  Facets open = box({0, 0, 0}, {1, 1, 1});
  open.pop_back();
  SurfaceSoup told = soup_of(open);
  told.sides.assign(told.triangles.size(), {1, 0});
  EXPECT_THROW(join_bodies(told, BaffleRule::keep), DataError);
}

// A cube with a square in its middle plane, which ends inside.
Facets cube_with_baffle() {
  const Vec3 a{0.25, 0.5, 0.25}, b{0.75, 0.5, 0.25}, c{0.75, 0.5, 0.75}, d{0.25, 0.5, 0.75};
  return joined(box({0, 0, 0}, {1, 1, 1}), Facets{{a, b, c}, {d, c, a}});  // pointing to both sides
}

TEST(Sheets, BafflesAreKeptAndTurnedToOneSide) {
  SurfaceSoup soup = soup_of(cube_with_baffle());
  EXPECT_EQ(find_sides(soup, ShellRule::oriented, BaffleRule::keep).baffles, 2u);
  const Surface surface = find_sheets(std::move(soup));
  ASSERT_EQ(surface.shells.size(), 2u);
  EXPECT_EQ(surface.shells[1].behind, 1);
  EXPECT_EQ(surface.shells[1].in_front, 1);
  EXPECT_EQ(surface.region_count, 1);
  EXPECT_NEAR(surface.volume(), 1, 1e-12);
  const auto normal = [&](std::size_t t) {
    const auto [a, b, c] = surface.triangles[t];
    return cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a]);
  };
  EXPECT_GT(dot(normal(12), normal(13)), 0);
}

TEST(Sheets, BafflesOutsideGo) {
  const Vec3 a{2, 0, 0}, b{3, 0, 0}, c{2, 1, 0};
  SurfaceSoup soup = soup_of(joined(box({0, 0, 0}, {1, 1, 1}), Facets{{a, b, c}}));
  const SheetReport report = find_sides(soup, ShellRule::oriented, BaffleRule::keep);
  EXPECT_EQ(report.baffles, 0u);
  EXPECT_EQ(report.fins, 1u);
  EXPECT_EQ(soup.triangles.size(), 12u);
}

TEST(SheetCut, TheFreeBorderOfABaffleIsAFeature) {
  SurfaceSoup soup = soup_of(cube_with_baffle());
  find_sides(soup, ShellRule::oriented, BaffleRule::keep);
  const Surface surface = find_sheets(std::move(soup));
  const SheetCut cut = cut_along_joints(surface);
  EXPECT_TRUE(cut.is_manifold);
  EXPECT_EQ(cut.joints.size(), 4u);
  const FeatureMesh mesh(surface, 40);
  std::size_t features = 0;
  for (const auto e : mesh.edges()) features += mesh.is_boundary(e) && mesh.is_feature(e) ? 1 : 0;
  EXPECT_EQ(features, 4u);
}

TEST(SheetCut, PartsAtTheRimOfAnInterface) {
  const SheetCut cut = cut_along_joints(sheets_of(boxes_with_common_face()));
  EXPECT_EQ(cut.point_of.size(), 8 + 8 + 4u);
  EXPECT_EQ(cut.joints.size(), 3 * 4u);
  EXPECT_TRUE(cut.is_manifold);
}

TEST(SheetCut, LeavesABodyWholeWhereItTouchesAnotherInAnEdge) {
  const Surface surface = sheets_of(boxes_with_common_edge());
  const SheetCut cut = cut_along_joints(surface);
  EXPECT_EQ(cut.point_of.size(), 8 + 8u);
  EXPECT_EQ(cut.joints.size(), 4u);
  std::map<std::set<Vertex>, int> triangles_at_joint;
  for (const auto& [from, to] : cut.joints) ++triangles_at_joint[{from, to}];
  EXPECT_EQ(triangles_at_joint.size(), 2u);  // of one body each
  for (const auto& [edge, count] : triangles_at_joint) EXPECT_EQ(count, 2);
}

TEST(FeatureMesh, CopiesOfAJointAreSplitKeptAndFoundTogether) {
  FeatureMesh mesh(sheets_of(boxes_with_common_face()), 40);
  int joints = 0;
  for (const auto e : mesh.edges()) joints += mesh.is_joint(e);
  EXPECT_EQ(joints, 12);
  OpenMesh::EdgeHandle joint;
  for (const auto e : mesh.edges())
    if (mesh.is_joint(e)) joint = e;
  const auto h = mesh.halfedge_handle(joint, 0);
  EXPECT_EQ(mesh.copies(h).size(), 3u);
  const Vec3 middle = 0.5 * (mesh.position(mesh.from_vertex_handle(h)) + mesh.position(mesh.to_vertex_handle(h)));
  const auto v = mesh.split_edge_at(joint, middle);
  mesh.keep(v);
  std::set<int> copies;
  mesh.for_each_copy(v, [&](OpenMesh::VertexHandle copy) {
    copies.insert(copy.idx());
    EXPECT_EQ(mesh.place(copy), mesh.place(v));
    EXPECT_TRUE(mesh.is_kept(copy));
    EXPECT_EQ(mesh.position(copy), middle);
    EXPECT_EQ(std::ranges::count_if(mesh.ve_range(copy), [&](auto e) { return mesh.is_joint(e); }), 2);
  });
  EXPECT_EQ(copies.size(), 3u);
}

TEST(FeatureCurves, ACurveOfJointsIsThereOnce) {
  const FeatureMesh mesh(sheets_of(boxes_with_common_face()), 40);
  EXPECT_EQ(feature_curves(mesh).size(), 8 + 8 + 4u);
}

TEST(FeatureMesh, WherePiecesTouchInAVertexAloneIsACorner) {
  const FeatureMesh mesh(sheets_of(joined(testing::sphere({0, 0, 0}, 1, 8), testing::sphere({0, 0, 2}, 1, 8))), 40);
  std::vector<Vec3> corners;
  for (const auto v : mesh.vertices())
    if (mesh.is_kept(v)) corners.push_back(mesh.position(v));
  EXPECT_EQ(corners, (std::vector<Vec3>{{0, 0, 1}, {0, 0, 1}}));
}

// On a closed surface, and on sheets with borders.
TEST(FeatureMesh, CollapsesEdgesAsOpenMeshDoes) {
  FeatureMesh in_sheets(sheets_of(boxes_with_common_face()), 40);
  refine_surface(in_sheets, 0.26, 1e-6);
  ASSERT_TRUE(std::ranges::any_of(in_sheets.edges(), [&](const auto e) { return in_sheets.is_boundary(e); }));
  for (FeatureMesh ours : {FeatureMesh(testing::surface_of(testing::sphere({0, 0, 0}, 1, 8)), 179), in_sheets}) {
    ASSERT_TRUE(ours.is_manifold());
    FeatureMesh theirs = ours;
    int collapses = 0;
    for (std::size_t i = 0; i < ours.n_halfedges(); i += 7) {
      const FeatureMesh::HalfedgeHandle h(static_cast<int>(i));
      if (!ours.is_collapse_ok(h)) continue;
      ++collapses;
      ours.collapse_edge(h);
      theirs.collapse(h);
      for (const auto v : theirs.all_vertices()) {
        ASSERT_EQ(ours.status(v).deleted(), theirs.status(v).deleted());
        ASSERT_EQ(ours.halfedge_handle(v), theirs.halfedge_handle(v));
      }
      for (const auto f : theirs.all_faces()) {
        ASSERT_EQ(ours.status(f).deleted(), theirs.status(f).deleted());
        if (theirs.status(f).deleted()) continue;
        ASSERT_EQ(ours.halfedge_handle(f), theirs.halfedge_handle(f));
      }
      for (const auto other : theirs.all_halfedges()) {
        const auto edge = theirs.edge_handle(other);
        ASSERT_EQ(ours.status(edge).deleted(), theirs.status(edge).deleted());
        if (theirs.status(edge).deleted()) continue;
        ASSERT_EQ(ours.next_halfedge_handle(other), theirs.next_halfedge_handle(other));
        ASSERT_EQ(ours.prev_halfedge_handle(other), theirs.prev_halfedge_handle(other));
        ASSERT_EQ(ours.to_vertex_handle(other), theirs.to_vertex_handle(other));
        ASSERT_EQ(ours.face_handle(other), theirs.face_handle(other));
      }
    }
    EXPECT_GT(collapses, 20);
  }
}

TEST(OppositeSides, AnInterfaceIsSeenFromBothOfItsSides) {
  FeatureMesh mesh(sheets_of(boxes_with_common_face()), 40);
  refine_surface(mesh, 0.26, 1e-6);
  const FieldSurface surface(mesh, 0.2);
  std::map<bool, int> seen_from, seen;  // by whether it is the interface
  for (const OppositeSide& side : opposite_sides(surface)) {
    ++seen_from[surface.is_interface[side.from]];
    ++seen[surface.is_interface[side.triangle]];
    const bool along_x = std::abs(surface.normals[side.from].x) > 0.5;
    EXPECT_TRUE(!along_x || surface.is_interface[side.from] != surface.is_interface[side.triangle]);
  }
  EXPECT_GT(seen_from[true], 0);
  EXPECT_NEAR(seen_from[true], seen[true], 0.2 * seen[true]);  // two ends see it, and it sees both of them
}

TEST(Remesh, BoxesThatTouchBecomeGridsWithOneInterface) {
  const Surface surface = sheets_of(boxes_with_common_face());
  const RemeshResult result = remesh_surface(surface, {.size = 0.25});
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.extra_points, 0u);
  EXPECT_EQ(result.surface.points.size(), 2 * (8 * 4 + 4 * 4 + 4 * 8) + 2 + 3 * 3u);
  for (const Vec3& p : result.surface.points)
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(p[axis] / 0.25, std::round(p[axis] / 0.25), 1e-6);
  for (const std::size_t region : {1, 2}) EXPECT_NEAR(result.surface.region_volumes()[region], 1, 1e-9);
  std::map<std::array<std::int32_t, 2>, int> triangles;  // by what is on their sides
  for (const auto& sides : result.surface.sides) ++triangles[sides];
  EXPECT_EQ((triangles[{1, 2}]), 2 * 4 * 4);
}

TEST(FieldNodes, ThoseWithinAnInterfaceFaceBothWays) {
  const Surface surface = remesh_surface(sheets_of(boxes_with_common_face()), {.size = 0.25}).surface;
  const tetmesh::tetgen::BuiltMesh built = mesh_of(surface, {});
  const auto nodes = tetmesh::volume::make_field_nodes(surface, built.mesh, built.adjacency, 0.25, 40);
  int within = 0;
  for (std::size_t v = 0; v < nodes.surface.size(); ++v) {
    within += nodes.surface[v].is_on_interface;
    EXPECT_TRUE(!nodes.surface[v].is_on_interface || std::abs(nodes.points[v].x - 1) < 1e-9);
  }
  EXPECT_EQ(within, 3 * 3);
}

// A pipe in its lining.
TEST(Remesh, RowsGoOnAcrossTheCurvesInWhichSheetsMeet) {
  const Surface surface = sheets_of(joined(ring(96, 0.5, 0.7, 1), ring(96, 0.7, 1, 1)));
  ASSERT_EQ(surface.region_count, 2);
  const RemeshResult result = remesh_surface(surface, {.size = 0.12});
  EXPECT_EQ(result.failure, "");
  std::map<int, int> on_rims;  // at the bottom, by the radius in hundredths
  for (const Vec3& p : result.surface.points)
    for (const int radius : {50, 70, 100})
      if (p.z == 0 && std::abs(100 * std::hypot(p.x, p.y) - radius) < 2) ++on_rims[radius];
  EXPECT_EQ(on_rims[50], on_rims[70]);
  EXPECT_EQ(on_rims[70], on_rims[100]);
  const std::vector<double> before = surface.region_volumes(), after = result.surface.region_volumes();
  for (const std::size_t region : {1, 2}) EXPECT_NEAR(after[region], before[region], 0.02 * before[region]);
}

// Vertices of the input on the curve go from all sheets, or stay in all of them.
TEST(Remesh, SheetsThatMeetInABentCurveFitTogether) {
  const Surface surface = sheets_of(joined(testing::prism(40, 1, 1), ring(40, 1, 1.6, 1)));
  ASSERT_EQ(surface.region_count, 2);
  for (const double size : {0.5, 0.2, 0.06}) {
    const RemeshResult result = remesh_surface(surface, {.size = size});
    EXPECT_EQ(result.failure, "");
    const Surface& made = result.surface;
    for_each_edge(made.points.size(), made.triangles, [&](std::span<const HalfEdge> edge) {
      std::map<std::int32_t, int> balance;  // of what is on the triangles' sides
      for (const HalfEdge h : edge) {
        const int sense = start_of(made.triangles, h) < end_of(made.triangles, h) ? 1 : -1;
        balance[made.sides[triangle_of(h)][0]] += sense;
        balance[made.sides[triangle_of(h)][1]] -= sense;
      }
      for (const auto& [region, sum] : balance) EXPECT_EQ(sum, 0);
    });
  }
}

}  // namespace
}  // namespace hexpipe
