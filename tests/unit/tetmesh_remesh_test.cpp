#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "common/run/random.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"
#include "tools/tetmesh/surface/bulges.hpp"
#include "tools/tetmesh/surface/remesh_steps.hpp"
#include "tools/tetmesh/surface/surface_distance.hpp"
#include "tools/tetmesh/surface/surface_remesh.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::geometry;
using namespace tetmesh::solid;
using namespace tetmesh::surface;
namespace {

using testing::box;
using testing::cube;
using testing::distance_between;
using testing::Facet;
using testing::Facets;
using testing::inverted;
using testing::joined;
using testing::naive_distance;
using testing::prism;
using testing::remesh_surface;
using testing::soup_of;
using testing::sphere;
using testing::surface_of;

TEST(DistanceIndex, AgreesWithLookingAtEveryTriangle) {
  const Surface surface = surface_of(joined(sphere({0, 0, 0}, 3, 9), box({5, -1, -1}, {9, 0.2, 0.1})));
  const DistanceIndex index(surface.points, surface.triangles);
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p{random.uniform(-5, 11), random.uniform(-5, 5), random.uniform(-5, 5)};
    const double distance = naive_distance(surface, p);
    EXPECT_NEAR(index.distance(p), distance, 1e-12);
    std::int32_t nearest = i % static_cast<std::int32_t>(surface.triangles.size());  // a wild guess
    EXPECT_NEAR(index.distance(p, nearest), distance, 1e-12);
    EXPECT_NEAR(index.distance(p, nearest), distance, 1e-12);
  }
}

// A few triangles are measured first. The one that is furthest away is not among them, and is found all the same.
TEST(OneSidedDistance, IsThatOfTheFurthestSample) {
  Surface rough = surface_of(sphere({0, 0, 0}, 1, 20));
  const Surface smooth = rough;
  const DistanceIndex of_smooth(smooth.points, smooth.triangles);
  Random random(5);
  for (Vec3& p : rough.points) p = random.uniform(1, 1.02) * p;
  for (const Vertex furthest : {Vertex{0}, Vertex{333}, static_cast<Vertex>(rough.points.size() - 1)}) {
    const Vec3 before = rough.points[furthest];
    rough.points[furthest] = 1.05 * before;
    const SurfaceDistance distance = one_sided_distance(rough.points, rough.triangles, of_smooth, 10, 0.04);
    EXPECT_NEAR(distance.greatest, naive_distance(smooth, rough.points[furthest]), 1e-12);
    ASSERT_EQ(distance.beyond.size(), 1u);
    EXPECT_EQ(distance.beyond[0], rough.points[furthest]);
    // The limit makes no difference to the greatest distance.
    EXPECT_EQ(one_sided_distance(rough.points, rough.triangles, of_smooth, 10, 1).greatest, distance.greatest);
    rough.points[furthest] = before;
  }
}

TEST(Remesh, BoxesBecomeGrids) {
  const Surface surface = surface_of(box({0, 0, 0}, {3, 2, 1}));
  const RemeshResult result = remesh_surface(surface, {.size = 0.25});
  EXPECT_EQ(result.failure, "");
  EXPECT_EQ(result.extra_points, 0u);
  EXPECT_LT(result.from_input, 1e-9);
  EXPECT_LT(result.to_input, 1e-9);
  EXPECT_EQ(result.surface.points.size(), 2 * (12 * 8 + 8 * 4 + 4 * 12) + 2u);
  for (const Vec3& p : result.surface.points)
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(p[axis] / 0.25, std::round(p[axis] / 0.25), 1e-6);
}

// A guide with points half a size off the whole numbers, everywhere.
RowGuide half_a_row_off() {
  const auto coordinates = [](const Vec3& place, const Vec3&, const std::array<Vec3, 2>& directions) {
    const auto number = [&](const Vec3& direction) {
      return std::polar(1.0, 2 * std::numbers::pi * (dot(place, direction) + 0.5));
    };
    return std::array{number(directions[0]), number(directions[1])};
  };
  return {coordinates, {}};
}

TEST(SurfaceRemesher, FollowsTheRowsOfAGuide) {
  const Surface surface = surface_of(box({0, 0, 0}, {10, 10, 10}));
  SurfaceRemesher remesher(surface, {.size = 1});
  ASSERT_TRUE(remesher.make());
  remesher.follow(half_a_row_off());
  ASSERT_TRUE(remesher.make());
  EXPECT_TRUE(remesher.judge());
  const RemeshResult result = remesher.take();
  std::size_t count = 0;
  for (const Vec3& p : result.surface.points) {
    if (p.z != 10 || std::min({p.x, p.y, 10 - p.x, 10 - p.y}) < 2) continue;
    ++count;
    for (const int k : {0, 1}) EXPECT_NEAR(p[k] - std::floor(p[k]), 0.5, 0.05);
  }
  EXPECT_EQ(count, 36u);
}

TEST(SurfaceRemesher, TakesTheKnownPointsOfAGuideFirst) {
  const Surface surface = surface_of(box({0, 0, 0}, {10, 10, 10}));
  SurfaceRemesher remesher(surface, {.size = 1});
  ASSERT_TRUE(remesher.make());
  RowGuide guide = half_a_row_off();
  guide.points = {{5.1, 4.8, 10.2}, {5.9, 4.9, 9.8}};  // beside the surface
  remesher.follow(guide);
  ASSERT_TRUE(remesher.make());
  const RemeshResult result = remesher.take();
  for (const Vec3& known : {Vec3{5.1, 4.8, 10}, Vec3{5.9, 4.9, 10}})
    EXPECT_TRUE(std::ranges::any_of(result.surface.points, [&](const Vec3& p) { return norm(p - known) < 0.03; }));
  std::size_t features = 0;
  for (std::size_t v = 0; v < result.surface.points.size(); ++v) features += result.on_feature[v];
  EXPECT_EQ(features, 12u * 9 + 8);
}

TEST(RefineSurface, CutsFansOfSliversIntoNoMorePointsThanTheyNeed) {
  const Surface surface = surface_of(prism(200, 1, 2));
  FeatureMesh mesh(surface, 40);
  refine_surface(mesh, 0.2, 1e-6);
  double longest = 0;
  for (const auto e : mesh.edges()) longest = std::max(longest, mesh.calc_edge_length(e));
  EXPECT_LE(longest, 0.2);
  for (const auto f : mesh.faces()) EXPECT_GT(norm(mesh.area_normal(f)), 0);
  const DistanceIndex input(surface.points, surface.triangles);
  std::vector<Vec3> points;
  for (const auto v : mesh.vertices()) {
    points.push_back(mesh.position(v));
    EXPECT_LT(input.distance(points.back()), 1e-9);
  }
  // An end has room for some 150; halving all slivers first, and flipping edges then, made 2,600.
  const auto inside =
      std::ranges::count_if(points, [](const Vec3& p) { return std::hypot(p.x, p.y) < 0.99 && p.z < 1e-9; });
  EXPECT_LT(inside, 500);
}

TEST(Remesh, StepsFitWhatIsThere) {
  // 2.9 / 0.25 = 11.6, 12 steps; likewise 9 and 4.
  const RemeshResult result = remesh_surface(surface_of(box({0, 0, 0}, {2.9, 2.2, 1.1})), {.size = 0.25});
  EXPECT_EQ(result.surface.points.size(), 2 * (12 * 9 + 9 * 4 + 4 * 12) + 2u);
}

TEST(Remesh, ResultIsASurfaceThatKeepsItsDistance) {
  const Facets hollow = joined(sphere({0, 0, 0}, 3, 16), inverted(sphere({0.4, 0.3, 0.2}, 1.6, 11)));
  const Facets nested = joined(cube(0, 4, 3), sphere({2, 2, 2}, 1.2, 13));
  for (const bool has_features : {false, true})
    for (const double deviation : {0.2, 0.03}) {
      const Facets& facets = has_features ? nested : hollow;
      const Surface surface = surface_of(facets);
      const RemeshResult result = remesh_surface(surface, {.size = 0.4, .deviation = deviation});
      ASSERT_EQ(result.failure, "");
      EXPECT_NO_THROW(check_surface(result.surface));
      EXPECT_LE(result.from_input, deviation * 0.4 * 1.001);
      EXPECT_LE(result.to_input, deviation * 0.4 * 1.001);
      const DistanceIndex input(surface.points, surface.triangles),
          output(result.surface.points, result.surface.triangles);
      // Vertices step out of the hollow ball, which has no features.
      const double out = has_features ? 1e-9 : 0.52 * deviation * 0.4;
      for (const Vec3& p : result.surface.points) EXPECT_LT(input.distance(p), out);
      for (const Vec3& p : surface.points) EXPECT_LE(output.distance(p), deviation * 0.4 * 1.001);
      const Surface found = find_shells(result.surface, ShellRule::oriented);
      ASSERT_EQ(found.shells.size(), 2u);
      EXPECT_EQ(found.region_count, surface.region_count);
      // A sphere of the least radius, 1.2, that has lost the deviation all around.
      for (std::size_t s = 0; s < 2; ++s)
        EXPECT_NEAR(found.shells[s].volume / surface.shells[s].volume, 1, 3 * deviation * 0.4 / 1.2);
    }
}

// Faces on a ball of 1.6 sizes would leave it by a sixth of a size, all to the inside. With its vertices on the ball 17
// to 30 points of the input stay.
TEST(Remesh, SharesTheDistanceOfFacesBetweenBothSidesOfABall) {
  for (const double radius : {1.6, 1.8, 2.0}) {
    const Surface ball = surface_of(sphere({0, 0, 0}, radius, 40));
    const RemeshResult result = remesh_surface(ball, {.size = 1});
    ASSERT_EQ(result.failure, "");
    EXPECT_LT(result.extra_points, 10u) << radius;
    EXPECT_LE(std::max(result.to_input, result.from_input), 0.15);
    EXPECT_LE(distance_between(ball, result.surface), 0.151);
    double furthest = 0;
    for (const Vec3& p : result.surface.points) furthest = std::max(furthest, norm(p));
    EXPECT_GT(furthest, radius + 0.01);
    EXPECT_NO_THROW(check_surface(result.surface));
  }
}

// A coarse ball, of which each face knows the point of the sphere above its middle.
struct CoarseBall {
  CoarseBall() {
    for (const auto f : mesh.faces()) {
      const auto [a, b, c] = mesh.positions(f);
      above.push_back({unit(a + b + c)});
    }
  }
  double furthest() const {
    double greatest = 0;
    for (const auto f : mesh.faces()) {
      const auto [a, b, c] = mesh.positions(f);
      greatest = std::max(greatest, std::sqrt(TriangleDistance(a, b, c).squared(above[f.idx()].front())));
    }
    return greatest;
  }
  FeatureMesh mesh{surface_of(sphere({0, 0, 0}, 1, 6)), 170};
  std::vector<std::vector<Vec3>> above;  // by face
};

TEST(StepOut, BringsFacesNearWithoutTakingVerticesFar) {
  CoarseBall ball;
  const double before = ball.furthest(), deviation = before / 1.5;
  step_out(ball.mesh, ball.above, FirmVertices(ball.mesh, {}, 1), deviation);
  EXPECT_LT(ball.furthest(), deviation);
  for (const auto v : ball.mesh.vertices()) {
    EXPECT_GE(norm(ball.mesh.position(v)), 1);
    EXPECT_LT(norm(ball.mesh.position(v)), 1 + 0.61 * deviation);
  }
}

TEST(StepOut, LeavesWhatIsNearEnough) {
  CoarseBall ball;
  const double deviation = 1.001 * ball.furthest();
  step_out(ball.mesh, ball.above, FirmVertices(ball.mesh, {}, 1), deviation);
  for (const auto v : ball.mesh.vertices()) EXPECT_NEAR(norm(ball.mesh.position(v)), 1, 1e-12);
}

// Three corners of a tip near each other: with the tip's own step one of its faces would turn by half a right angle.
TEST(StepOut, TurnsNoFace) {
  CoarseBall ball;
  const double deviation = ball.furthest() / 1.5;
  const auto f = *ball.mesh.faces_begin();
  const auto [a, b, c] = ball.mesh.corners(f);
  const Vec3 pa = ball.mesh.position(a), pb = ball.mesh.position(b);
  const Vec3 middle = 0.5 * (pa + pb), pc = ball.mesh.position(c);
  ball.mesh.set_point(c, to_open_mesh(middle + 0.1 * deviation * unit(pc - middle)));
  std::vector<std::array<Vec3, 3>> before;
  for (const auto g : ball.mesh.faces()) before.push_back(ball.mesh.positions(g));
  const std::vector<Vec3> faults{pa, pb};
  step_out(ball.mesh, ball.above, FirmVertices(ball.mesh, std::array{&faults}, 1e-6), deviation);
  std::size_t i = 0, moved = 0;
  for (const auto g : ball.mesh.faces()) {
    const auto [p, q, r] = before[i++];
    const auto [x, y, z] = ball.mesh.positions(g);
    moved += x != p || y != q || z != r;
    EXPECT_GT(dot(unit(cross(q - p, r - p)), unit(cross(y - x, z - x))), 0.82);
  }
  EXPECT_GT(moved, 10u);
  EXPECT_EQ(ball.mesh.position(c), middle + 0.1 * deviation * unit(pc - middle));
}

TEST(StepOut, LeavesFirmVertices) {
  CoarseBall ball, without_faults;
  const double deviation = ball.furthest() / 1.5;
  const std::vector<Vec3> faults{{0, 0, 1}};
  const FirmVertices firm(ball.mesh, std::array{&faults}, 0.8);
  step_out(ball.mesh, ball.above, firm, deviation);
  step_out(without_faults.mesh, without_faults.above, FirmVertices(without_faults.mesh, {}, 1), deviation);
  std::size_t firm_ones = 0;
  for (const auto v : ball.mesh.vertices()) {
    const Vec3 here = ball.mesh.position(v);
    EXPECT_EQ(firm.has(v), norm(unit(here) - faults[0]) <= 0.8);
    EXPECT_NEAR(norm(here), firm.has(v) ? 1 : norm(without_faults.mesh.position(v)), 1e-12);
    firm_ones += firm.has(v);
  }
  EXPECT_GT(firm_ones, 0u);
  EXPECT_LT(firm_ones, ball.mesh.n_vertices() / 2);
}

TEST(Remesh, KeepsTagsAndTheAreaOfEach) {
  SurfaceSoup soup = soup_of(box({0, 0, 0}, {2, 1, 1}, 4));
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    const auto [a, b, c] = soup.triangles[i];
    soup.tags[i] = 7 + ((soup.points[a] + soup.points[b] + soup.points[c]).x < 3);
  }
  const RemeshResult result = remesh_surface(find_shells(soup, ShellRule::oriented), {.size = 0.2});
  ASSERT_EQ(result.failure, "");
  std::map<std::int32_t, double> area;
  for (std::size_t i = 0; i < result.surface.triangles.size(); ++i) {
    const auto [a, b, c] = result.surface.triangles[i];
    const auto& points = result.surface.points;
    area[result.surface.tags[i]] += norm(cross(points[b] - points[a], points[c] - points[a])) / 2;
  }
  ASSERT_EQ(area.size(), 2u);
  EXPECT_NEAR(area[7], 5, 1e-9);
  EXPECT_NEAR(area[8], 5, 1e-9);
}

TEST(Remesh, SameInputGivesTheSamePoints) {
  const Surface surface = surface_of(sphere({0, 0, 0}, 1, 14));
  const auto first = remesh_surface(surface, {.size = 0.2}), second = remesh_surface(surface, {.size = 0.2});
  EXPECT_EQ(first.surface.points, second.surface.points);
  EXPECT_EQ(first.surface.triangles, second.surface.triangles);
}

TEST(Remesh, KeepsThinWallsApart) {
  // Two layers of 0.02 with a gap of 0.02: at a size of 0.3, a chord of the curved ones may cross the next.
  Facets shells;
  for (const double radius : {1.0, 1.04}) {
    shells = joined(shells, sphere({0, 0, 0}, radius, 14));
    shells = joined(shells, inverted(sphere({0, 0, 0}, radius - 0.02, 14)));
  }
  const RemeshResult result = remesh_surface(surface_of(shells), {.size = 0.3, .deviation = 0.5});
  if (result.failure.empty()) {
    EXPECT_NO_THROW(check_surface(result.surface));
  }
}

// A square bar whose long edges are rounded in steps, closed by fans.
Surface rounded_bar(double radius, int steps, double length) {
  std::vector<Vec3> outline;
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i <= steps; ++i) {
      const double angle = std::numbers::pi / 2 * (side + static_cast<double>(i) / steps);
      const Vec3 corner{side == 0 || side == 3 ? 1. : -1., side < 2 ? 1. : -1., 0};
      outline.push_back(corner + radius * Vec3{std::cos(angle), std::sin(angle), 0});
    }
  Facets facets;
  const Vec3 centre{0, 0, 0}, up{0, 0, length};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3 a = outline[i], b = outline[(i + 1) % outline.size()];
    facets.insert(facets.end(), {Facet{a, b, b + up}, Facet{a, b + up, a + up}, Facet{centre, b, a},
                                 Facet{centre + up, a + up, b + up}});
  }
  return surface_of(facets);
}

TEST(RemoveVertices, StaysNearThePointsThatItLeftBehindBefore) {
  constexpr double deviation = 0.02, limit = 1.15 * deviation;
  const Surface surface = rounded_bar(0.1, 12, 5);
  const DistanceIndex input(surface.points, surface.triangles);
  FeatureMesh mesh(surface, 40);
  refine_surface(mesh, 0.8, 1e-6);
  const auto surface_after = [&](const CloseWatch& watch) {
    FeatureMesh copy = mesh;
    remove_vertices(copy, input, {deviation, 10}, watch);
    return copy.to_surface(surface);
  };
  const Surface first = surface_after({});
  const std::vector<Vec3> left_behind =
      one_sided_distance(surface.points, surface.triangles, DistanceIndex(first.points, first.triangles), 0.1, limit)
          .beyond;
  ASSERT_GT(left_behind.size(), 10u);
  const Surface second = surface_after({left_behind, {}});
  const DistanceIndex output(second.points, second.triangles);
  for (const Vec3& p : left_behind) EXPECT_LE(output.distance(p), limit);
}

TEST(RemoveVertices, LeavesFacesThatAreHeld) {
  const Surface surface = surface_of(sphere({0, 0, 0}, 5, 30));
  FeatureMesh mesh(surface, 40);
  std::vector<std::array<Vec3, 3>> held, left;
  for (const auto f : mesh.faces())
    if (mesh.position(mesh.corners(f)[0]).z > 4) {
      mesh.hold(f);
      held.push_back(mesh.positions(f));
    }
  ASSERT_GT(held.size(), 100u);
  remove_vertices(mesh, DistanceIndex(surface.points, surface.triangles), {0.5, 10});
  for (const auto f : mesh.faces()) left.push_back(mesh.positions(f));
  EXPECT_LT(left.size(), held.size() + 300);
  for (const std::array<Vec3, 3>& face : held) EXPECT_NE(std::ranges::find(left, face), left.end());
}

// A pin as thin as this bends so much that edges between two rows of points would leave it.
TEST(Remesh, LeavesNoLongEdgesWhereTheSurfaceBendsMuch) {
  const RemeshResult result = remesh_surface(surface_of(prism(64, 0.55, 30)), {.size = 1});
  ASSERT_EQ(result.failure, "");
  double longest = 0, least_sine = 1;
  for (const Triangle& t : result.surface.triangles)
    for (int i = 0; i < 3; ++i) {
      const Vec3 &p = result.surface.points[t[i]], &q = result.surface.points[t[(i + 1) % 3]],
                 &r = result.surface.points[t[(i + 2) % 3]];
      longest = std::max(longest, norm(q - p));
      least_sine = std::min(least_sine, norm(cross(q - p, r - p)) / (norm(q - p) * norm(r - p)));
    }
  EXPECT_LT(longest, 2.5);
  EXPECT_GT(least_sine, 0.05);
}

// With four points on a rim, its chords leave it by less than the deviation, and by more than removed vertices may.
TEST(Remesh, LeavesNoPointsOfTheInputOnRims) {
  for (const double radius : {0.45, 0.48, 0.5}) {
    const RemeshResult result = remesh_surface(surface_of(prism(96, radius, 4)), {.size = 1});
    ASSERT_EQ(result.failure, "");
    double shortest = 1, longest = 0;
    for (const Triangle& t : result.surface.triangles)
      for (int i = 0; i < 3; ++i) {
        const Vec3 &p = result.surface.points[t[i]], &q = result.surface.points[t[(i + 1) % 3]];
        const Vec3 middle = 0.5 * (p + q);
        if (p.z != q.z || std::hypot(middle.x, middle.y) < 0.65 * radius) continue;  // not along a rim
        shortest = std::min(shortest, norm(q - p));
        longest = std::max(longest, norm(q - p));
      }
    EXPECT_GT(shortest, 0.7 * longest) << radius;
  }
}

TEST(Remesh, KeepsItsDistanceAtRoundedEdgesWithFewMorePoints) {
  const RemeshResult result = remesh_surface(rounded_bar(0.1, 12, 3), {.size = 0.3, .deviation = 0.06});
  ASSERT_EQ(result.failure, "");
  EXPECT_NO_THROW(check_surface(result.surface));
  EXPECT_LT(std::max(result.from_input, result.to_input), 0.06 * 0.3 * 1.001);
  EXPECT_GT(result.attempts, 1);
  EXPECT_LE(result.attempts, 3);
  EXPECT_LT(result.extra_points, 80u);
}

TEST(Remesh, GivesUpBeforeMemoryDoes) {
  const RemeshResult result = remesh_surface(surface_of(cube()), {.size = 1e-6});
  EXPECT_NE(result.failure, "");
  EXPECT_TRUE(result.surface.points.empty());
}

TEST(Remesh, LeavesAPartFarSmallerThanTheSizeItsShape) {
  const RemeshResult result = remesh_surface(surface_of(cube(0, 1, 3)), {.size = 50});
  ASSERT_EQ(result.failure, "");
  EXPECT_EQ(result.surface.points.size(), 8u);
  EXPECT_EQ(result.surface.triangles.size(), 12u);
}

}  // namespace
}  // namespace hexpipe
