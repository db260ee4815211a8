#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <span>
#include <sstream>
#include <vector>

#include "common/candidates/findhex.hpp"
#include "common/run/error.hpp"
#include "common/run/parallel.hpp"
#include "common/run/random.hpp"
#include "findhex_meshes.hpp"
#include "tools/findhex/report.hpp"

namespace hexpipe {
using namespace findhex;
using namespace candidates;
namespace {

using testing::cube_points;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using testing::five_tets;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kuhn_lattice;
using testing::mesh_of;
using testing::six_tets;
using ::testing::ThrowsMessage;

Candidates find(const TetMesh& mesh, const FindhexOptions& options = {}) {
  Candidates found = candidates::findhex(mesh, options, "test").candidates;
  validate(found, "candidates");
  validate_against(found, mesh, "candidates");
  return found;
}

FindhexOptions with(void (*change)(FindhexOptions&)) {
  FindhexOptions options;
  change(options);
  return options;
}

TEST(Findhex, FindsACubeOfSixTets) {
  const Candidates found = find(mesh_of(cube_points(), six_tets()));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found.corners_of(0), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(found.interior_tets_of(0), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(found.boundary_tets_of(0), IsEmpty());
  EXPECT_EQ(found.kind[0], CellKind::hex);
  EXPECT_DOUBLE_EQ(found.quality[0], 1);
  EXPECT_DOUBLE_EQ(found.volume[0], 1);
}

TEST(Findhex, FindsACubeOfFiveTets) {
  const Candidates found = find(mesh_of(cube_points(), five_tets()));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found.interior_tets_of(0), ElementsAre(0, 1, 2, 3, 4));
}

TEST(Findhex, FindsPrismsAndPyramids) {
  TetMesh prism = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
                          {{0, 1, 2, 5}, {0, 1, 5, 4}, {0, 4, 5, 3}});
  const FindhexOptions options = with([](FindhexOptions& o) { o.kinds = {CellKind::prism, CellKind::pyramid}; });
  Candidates found = find(prism, options);
  // Two of the three tets, where they lie at one quad, are a pyramid.
  ASSERT_THAT(found.kind, ElementsAre(CellKind::prism, CellKind::pyramid, CellKind::pyramid));
  EXPECT_THAT(found.vertices[0], ElementsAre(0, 1, 2, 3, 4, 5, -1, -1));
  EXPECT_THAT(found.interior_tets_of(0), ElementsAre(0, 1, 2));
  EXPECT_DOUBLE_EQ(found.volume[0], 0.5);
  EXPECT_THAT(found.vertices[1], ElementsAre(0, 3, 4, 1, 5, -1, -1, -1));
  EXPECT_THAT(found.interior_tets_of(1), ElementsAre(1, 2));
  EXPECT_THAT(found.interior_tets_of(2), ElementsAre(0, 1));
}

// counts.csv: by the published method's own program.
TEST(Findhex, CountsOfLatticesArePublishedOnes) {
  std::ifstream file(std::string(HEXPIPE_TEST_DATA) + "/lattices/counts.csv");
  int compared = 0;
  for (std::string line; std::getline(file, line);) {
    std::stringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (row[0] != "kuhn" || std::stoi(row[1]) > 5) continue;
    FindhexOptions options;
    options.min_quality = std::stod(row[4]);
    options.quality = CandidateQuality::corner;
    options.drop_folded_quads = false;
    options.tet_rules.sharp_edges = true;
    options.tet_rules.max_boundary_tets = 5;
    options.tet_rules.flat_corners = true;
    EXPECT_EQ(find(kuhn_lattice(std::stoi(row[1])), options).size(), std::stoul(row[5])) << line;
    ++compared;
  }
  EXPECT_GE(compared, 10);
}

TEST(Findhex, ThresholdIsStrict) {
  // All corners of a cube have quality 1.
  const TetMesh mesh = mesh_of(cube_points(), six_tets());
  EXPECT_EQ(find(mesh, with([](FindhexOptions& o) { o.min_quality = 0.999; })).size(), 1u);
  EXPECT_EQ(find(mesh, with([](FindhexOptions& o) { o.min_quality = 1; })).size(), 0u);
}

TEST(Findhex, RegionsAreNotMergedAcross) {
  TetMesh mesh = mesh_of(cube_points(), six_tets());
  mesh.tet_tags = {1, 1, 1, 2, 2, 2};
  EXPECT_EQ(find(mesh).size(), 0u);
  mesh.tet_tags = {2, 2, 2, 2, 2, 2};
  EXPECT_EQ(find(mesh).size(), 1u);
}

TEST(Findhex, BothTrianglesOfAQuadHaveOneSurfaceTag) {
  TetMesh mesh = mesh_of(cube_points(), six_tets());
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  mesh.triangle_tags = {7, 7};
  EXPECT_EQ(find(mesh).size(), 1u);
  mesh.triangle_tags = {7, 8};
  EXPECT_EQ(find(mesh).size(), 0u);
  // The other one is derived, with tag 0.
  mesh.triangles = {{0, 2, 1}};
  mesh.triangle_tags = {0};
  EXPECT_EQ(find(mesh).size(), 1u);
  mesh.triangle_tags = {7};
  EXPECT_EQ(find(mesh).size(), 0u);
}

TEST(Findhex, ATaggedTriangleInsideIsNotMergedAcross) {
  TetMesh mesh = mesh_of(cube_points(), six_tets());
  mesh.triangles = {{0, 2, 6}};
  mesh.triangle_tags = {0};
  EXPECT_EQ(find(mesh).size(), 0u);
}

// A tet on half of one quad: that half is inside the mesh, the other on its boundary.
TEST(Findhex, BothTrianglesOfAQuadAreOnTheBoundaryOrInside) {
  auto points = cube_points();
  auto tets = six_tets();
  points.push_back({0.7, 0.3, -1});
  tets.push_back({0, 1, 2, 8});
  EXPECT_EQ(find(mesh_of(points, tets)).size(), 0u);
  tets.push_back({0, 2, 3, 8});
  EXPECT_EQ(find(mesh_of(points, tets)).size(), 1u);
}

TEST(Findhex, InnerVerticesAreAllowedOrForbidden) {
  auto points = cube_points();
  points.push_back({0.5, 0.5, 0.5});
  std::vector<Tet> tets;
  for (const auto& q : HexTopology::quads) {
    tets.push_back({8, q[0], q[1], q[2]});
    tets.push_back({8, q[0], q[2], q[3]});
  }
  const TetMesh mesh = mesh_of(points, tets);
  const Candidates found = find(mesh);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.interior_tets_of(0).size(), 12u);
  EXPECT_EQ(find(mesh, with([](FindhexOptions& o) { o.tet_rules.inner_vertices = false; })).size(), 0u);
}

// Each quad is warped outward at the corners 1, 3, 4, 6, and a sliver fills it up.
TetMesh cube_with_slivers(double warp) {
  auto points = cube_points();
  for (const int v : {1, 3, 4, 6}) points[v] = points[v] + warp * (points[v] - Vec3{0.5, 0.5, 0.5});
  auto tets = five_tets();
  for (const auto& q : HexTopology::quads) tets.push_back({q[0], q[1], q[2], q[3]});
  return mesh_of(points, tets);
}

TEST(Findhex, ACubeMayHaveSixBoundaryTets) {
  const TetMesh mesh = cube_with_slivers(0.1);
  const Candidates found = find(mesh);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found.interior_tets_of(0), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(found.boundary_tets_of(0), ElementsAre(5, 6, 7, 8, 9, 10));
  // The published program takes five at most.
  EXPECT_EQ(find(mesh, with([](FindhexOptions& o) { o.tet_rules.max_boundary_tets = 5; })).size(), 0u);
}

// Two hexes at one warped quad, of which each sees another diagonal: the sliver is a boundary tet of both.
TEST(Findhex, TwoHexesShareABoundaryTet) {
  auto points = cube_points();
  for (Vec3 top : {Vec3{0, 0, 2}, Vec3{1, 0, 2}, Vec3{1, 1, 2}, Vec3{0, 1, 2}}) points.push_back(top);
  points[5].z = points[7].z = 1.1;
  std::vector<Tet> tets = six_tets();  // with the diagonal 46 on top
  tets.push_back({4, 5, 6, 7});
  for (const Tet& tet : five_tets()) {  // with 57 below, and 4 5 6 7 for 0 1 2 3
    auto turned = [](Vertex v) { return (v / 4 + 1) * 4 + (v + 1) % 4; };
    tets.push_back({turned(tet[0]), turned(tet[1]), turned(tet[2]), turned(tet[3])});
  }
  const Candidates found = find(mesh_of(points, tets), with([](FindhexOptions& o) { o.min_quality = 0.8; }));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_THAT(found.boundary_tets_of(0), ElementsAre(6));
  EXPECT_THAT(found.boundary_tets_of(1), ElementsAre(6));
}

TEST(Findhex, FoldedQuadsAreDroppedOrKept) {
  auto points = cube_points();
  points[5].z = points[7].z = 2;
  const TetMesh mesh = mesh_of(points, six_tets());
  const auto on_surfaces = [](FindhexOptions& o) { o.tet_rules.sharp_edges = true; };
  EXPECT_EQ(find(mesh, with(on_surfaces)).size(), 0u);
  EXPECT_EQ(find(mesh, with([](FindhexOptions& o) {
                   o.tet_rules.sharp_edges = true;
                   o.drop_folded_quads = false;
                 }))
                .size(),
            1u);
  points[5].z = points[7].z = 1.5;
  EXPECT_EQ(find(mesh_of(points, six_tets()), with(on_surfaces)).size(), 1u);
}

// Rule 10 for a top that turns by 2 atan(sqrt(2) h): 38.9 degrees at h = 0.25, 43.2 at 0.28.
TEST(Findhex, NoQuadLiesOverASharpEdge) {
  auto points = cube_points();
  points[5].z = points[7].z = 1.25;
  EXPECT_EQ(find(mesh_of(points, six_tets())).size(), 1u);
  points[5].z = points[7].z = 1.28;
  TetMesh mesh = mesh_of(points, six_tets());
  EXPECT_EQ(find(mesh).size(), 0u);
  EXPECT_EQ(find(mesh, with([](FindhexOptions& o) { o.feature_angle = 45; })).size(), 1u);
  mesh.ridges = {{4, 6}};
  EXPECT_EQ(find(mesh, with([](FindhexOptions& o) { o.feature_angle = 180; })).size(), 0u);
  mesh.ridges = {{5, 7}};
  EXPECT_EQ(find(mesh, with([](FindhexOptions& o) { o.feature_angle = 180; })).size(), 1u);
}

// The quad on top is folded at 46, but a tet on it has triangles at 57 as well, which are not.
TEST(Findhex, AQuadIsNotFoldedWhereOneOfItsDiagonalsIsNot) {
  auto points = cube_points();
  points[5] = {0.7, 0.3, 1.5};
  points[7] = {0.3, 0.7, 1.5};
  auto tets = six_tets();
  const FindhexOptions low = with([](FindhexOptions& o) {
    o.min_quality = 0.1;
    o.tet_rules.sharp_edges = true;
  });
  EXPECT_EQ(find(mesh_of(points, tets), low).size(), 0u);
  tets.push_back({4, 5, 6, 7});
  const Candidates found = find(mesh_of(points, tets), low);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found.boundary_tets_of(0), ElementsAre(6));
}

// Good corners are not enough.
TEST(Findhex, OnlyValidHexesAreCandidates) {
  const TetMesh mesh = kuhn_lattice(3);
  FindhexOptions options;
  options.min_quality = 0.0001;
  options.drop_folded_quads = false;
  Random random(1);
  std::int64_t invalid = 0;
  for (int n = 0; n < 10; ++n) {
    TetMesh moved = mesh;
    for (Vec3& p : moved.points) p += {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2)};
    invalid += candidates::findhex(moved, options, "test").counts[0].counts.invalid;
  }
  EXPECT_GT(invalid, 0);
}

TEST(Findhex, InvertedAndFlatTetsAreCountedAndNotUsed) {
  TetMesh mesh = kuhn_lattice(3);
  const std::size_t all = find(mesh).size();
  // An inner vertex pushed through its neighbourhood inverts some tets; two at the same place flatten some.
  mesh.points[21] = {2.2, 1, 0.7};
  FindhexResult result = candidates::findhex(mesh, {}, "test");
  EXPECT_GT(result.findings.orientation.inverted, 0);
  EXPECT_LT(result.candidates.size(), all);
  EXPECT_GT(result.candidates.size(), 0u);
  const auto& signs = result.findings.orientation.signs;
  for (const auto* tets : {&result.candidates.tets, &result.candidates.boundary_tets})
    for (const TetIndex tet : *tets) EXPECT_EQ(signs[tet], 1);
  EXPECT_THAT(warnings_about(result.findings), ElementsAre(HasSubstr("inverted")));

  mesh = kuhn_lattice(3);
  mesh.points[21] = mesh.points[42] = {1.5, 1.5, 1.5};
  result = candidates::findhex(mesh, {}, "test");
  EXPECT_GT(result.findings.orientation.flat, 0);
  EXPECT_THAT(warnings_about(result.findings), ElementsAre(HasSubstr("flat")));
}

TEST(Findhex, ListedInsideOutIsNotInverted) {
  const TetMesh mesh = kuhn_lattice(2);
  TetMesh turned = mesh;
  for (Tet& tet : turned.tets) std::swap(tet[0], tet[1]);
  FindhexResult result = candidates::findhex(turned, {}, "test");
  EXPECT_EQ(result.candidates, find(mesh));
  EXPECT_EQ(result.findings.orientation.turned, 48);
  EXPECT_THAT(warnings_about(result.findings), IsEmpty());

  turned = mesh;
  std::swap(turned.tets[5][0], turned.tets[5][1]);
  result = candidates::findhex(turned, {}, "test");
  EXPECT_EQ(result.candidates, find(mesh));
  EXPECT_EQ(result.findings.orientation.inverted, 0);
  EXPECT_THAT(warnings_about(result.findings), ElementsAre(HasSubstr("1 of 48 tets")));
}

TEST(Findhex, ThreeTetsAtAFacetAreAnError) {
  auto points = cube_points();
  auto tets = six_tets();
  points.push_back({0.5, 0.5, 0.4});
  tets.insert(tets.begin(), {1, 2, 5, 6});
  tets.push_back({0, 1, 6, 8});
  EXPECT_THAT(
      [&] { find(mesh_of(points, tets)); },
      ThrowsMessage<DataError>(HasSubstr("at most two tets at each facet, found tets 2, 7 and 8 at vertices 1 2 7")));
}

// Tets of two regions in another order: the same cells, of the same tets under their numbers there.
TEST(Findhex, TetsAreNumberedAsTheMeshHasThem) {
  TetMesh mesh = kuhn_lattice(4);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.tet_tags[t] = mesh.points[mesh.tets[t][0]].x < 1.5 ? 1 : 2;
  std::vector<std::int32_t> order(mesh.tets.size());
  std::iota(order.begin(), order.end(), 0);
  Random(3).shuffle(std::span(order));
  TetMesh shuffled = mesh;
  for (std::size_t t = 0; t < order.size(); ++t) {
    shuffled.tets[t] = mesh.tets[order[t]];
    shuffled.tet_tags[t] = mesh.tet_tags[order[t]];
  }
  const FindhexOptions all = with([](FindhexOptions& o) {
    o.kinds = {CellKind::hex, CellKind::prism, CellKind::pyramid};
  });
  const Candidates expected = find(mesh, all), found = find(shuffled, all);
  ASSERT_EQ(found.vertices, expected.vertices);
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::vector<std::int32_t> tets;
    for (const TetIndex tet : found.interior_tets_of(i)) tets.push_back(order[tet]);
    std::sort(tets.begin(), tets.end());
    EXPECT_THAT(tets, ElementsAreArray(expected.interior_tets_of(i)));
  }
}

TEST(Findhex, AnEmptyMeshHasNoCandidates) {
  EXPECT_EQ(find(TetMesh{}).size(), 0u);
  EXPECT_EQ(find(mesh_of(cube_points(), {})).size(), 0u);
}

TEST(Findhex, CornerQualityIsAtLeastTheElements) {
  TetMesh mesh = kuhn_lattice(3);
  Random random(2);
  for (Vec3& p : mesh.points) p += {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
  const Candidates element = find(mesh);
  Candidates corner = find(mesh, with([](FindhexOptions& o) { o.quality = CandidateQuality::corner; }));
  ASSERT_EQ(corner.vertices, element.vertices);
  bool less = false;
  for (std::size_t i = 0; i < corner.size(); ++i) {
    EXPECT_GT(corner.quality[i], 0.3);
    EXPECT_LE(element.quality[i], corner.quality[i]);
    less = less || element.quality[i] < corner.quality[i];
  }
  EXPECT_TRUE(less);
  corner.quality = element.quality;
  EXPECT_EQ(corner, element);
}

TEST(Findhex, ComesByCornerZeroTheSameForAnyThreads) {
  const TetMesh mesh = kuhn_lattice(5);
  const FindhexOptions options = with([](FindhexOptions& o) {
    o.kinds = {CellKind::hex, CellKind::prism, CellKind::pyramid};
  });
  auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return candidates::findhex(mesh, options, "test");
  };
  const FindhexResult one = with_threads(1), two = with_threads(2);
  EXPECT_EQ(one.candidates, two.candidates);
  ASSERT_EQ(one.counts.size(), 3u);
  for (std::size_t i = 1; i < one.candidates.size(); ++i) {
    if (one.candidates.kind[i] != one.candidates.kind[i - 1]) continue;
    EXPECT_LE(one.candidates.vertices[i - 1][0], one.candidates.vertices[i][0]);
  }
}

TEST(Findhex, CountsAddUp) {
  const FindhexResult result = candidates::findhex(kuhn_lattice(4), {}, "test");
  const CellCounts& counts = result.counts[0].counts;
  std::int64_t judged = counts.invalid;
  for (const std::int64_t n : counts.by_verdict) judged += n;
  EXPECT_EQ(judged, counts.complete);
  EXPECT_EQ(counts.accepted(), static_cast<std::int64_t>(result.candidates.size()));
  EXPECT_EQ(statistics_of(result)["hexes"]["candidates"], counts.accepted());
}

}  // namespace
}  // namespace hexpipe
