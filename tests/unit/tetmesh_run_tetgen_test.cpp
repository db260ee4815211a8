#include "tools/tetmesh/tetgen/run_tetgen.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "common/run/error.hpp"
#include "surface_samples.hpp"
#include "tools/tetmesh/tetgen/build_mesh.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::solid;
using namespace tetmesh::tetgen;
namespace {

using testing::cube;
using testing::Facets;
using ::testing::HasSubstr;
using testing::inverted;
using testing::joined;
using testing::soup_of;
using testing::sphere;

constexpr double timeout = 60;

Surface oriented_shells_of(const Facets& facets) {
  return find_shells(soup_of(facets), ShellRule::oriented);
}

TetGenResult tets_of(const SurfaceSoup& soup, std::span<const Vec3> points = {}, double seconds = timeout) {
  return run_tetgen({soup.points, soup.triangles, points, 0}, seconds);
}

std::string error_of_tets(const Surface& surface, TetGenResult result, std::span<const Vec3> points = {}) {
  try {
    build_mesh(surface, points, std::move(result));
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

double volume_of_region(const TetMesh& mesh, std::int32_t region) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (mesh.tet_tags[t] == region) volume += tet_determinant(mesh.points, mesh.tets[t]) / 6;
  return volume;
}

TEST(RunTetgen, KeepsSurfaceAndPointsInTheirOrder) {
  const Surface surface = oriented_shells_of(cube(0, 4, 4));
  const std::vector<Vec3> points{{2.1, 2, 2}, {1, 1, 1.2}, {3, 1.5, 1}, {1, 2.9, 3}};
  const TetGenResult result = tets_of(surface, points);
  EXPECT_EQ(result.failure, "");
  ASSERT_EQ(result.points.size(), surface.points.size() + points.size());
  EXPECT_TRUE(std::equal(surface.points.begin(), surface.points.end(), result.points.begin()));
  EXPECT_TRUE(std::equal(points.begin(), points.end(), result.points.begin() + surface.points.size()));

  const BuiltMesh built = build_mesh(surface, points, result);
  EXPECT_EQ(built.added_points, 0u);
  EXPECT_EQ(built.dropped_points, 0u);
  EXPECT_EQ(built.mesh.triangles, surface.triangles);
  EXPECT_NEAR(volume_of_region(built.mesh, 1), 64, 1e-9);
}

TEST(RunTetgen, AShuffledOrderChangesTetsOnly) {
  const Surface surface = oriented_shells_of(sphere({0, 0, 0}, 4, 12));
  const std::vector<Vec3> points{{2.1, 2, 2}, {1, 1, 1.2}, {-1, 0.5, 1}, {1, -2, -1}};
  std::vector<std::vector<Tet>> tets;
  for (const std::uint64_t order : {0, 1, 2}) {
    const TetGenResult result = run_tetgen({surface.points, surface.triangles, points, order}, timeout);
    EXPECT_EQ(error_of_tets(surface, result, points), "no error");
    EXPECT_TRUE(std::equal(points.begin(), points.end(), result.points.begin() + surface.points.size()));
    tets.push_back(result.tets);
  }
  EXPECT_NE(tets[0], tets[1]);
  EXPECT_NE(tets[1], tets[2]);
}

TEST(RunTetgen, TellsApartWhatNearlyTouchesWhereItIsStrict) {
  Facets beside = cube(0, 1);
  for (auto& facet : beside)
    for (Vec3& p : facet) p.x += 1 + 1e-9;
  const Surface surface = oriented_shells_of(joined(cube(0, 1), beside));
  const auto error = [&](bool strict) {
    return error_of_tets(
        surface,
        run_tetgen(
            {.surface_points = surface.points, .triangles = surface.triangles, .interior_points = {}, .strict = strict},
            timeout));
  };
  EXPECT_THAT(error(false), HasSubstr("TetGen failed"));
  EXPECT_EQ(error(true), "no error");
}

TEST(RunTetgen, EmptiesHolesAndSeparatesRegions) {
  const Facets facets = joined(joined(cube(0, 8), inverted(cube(1, 3))), cube(5, 2));
  const Surface surface = oriented_shells_of(facets);
  const BuiltMesh built = build_mesh(surface, {}, tets_of(surface));
  EXPECT_NEAR(volume_of_region(built.mesh, 1), 512 - 27 - 8, 1e-9);
  EXPECT_NEAR(volume_of_region(built.mesh, 2), 8, 1e-9);
  EXPECT_EQ(std::ranges::count(built.mesh.tet_tags, 0), 0);
}

TEST(RunTetgen, NamesIntersectingTriangles) {
  const SurfaceSoup soup = soup_of(joined(cube(), cube(0.5)));
  const TetGenResult result = tets_of(soup);
  EXPECT_EQ(result.failure, "it found triangles that intersect");
  EXPECT_GE(result.intersecting.size(), 2u);
  EXPECT_TRUE(result.tets.empty());
  const Surface surface{soup, std::vector<std::int32_t>(24), {Shell{}}, 1};
  EXPECT_THAT(error_of_tets(surface, result), HasSubstr("part: triangle "));
  EXPECT_THAT(error_of_tets(surface, result), HasSubstr("TetGen failed: it found"));
}

TEST(RunTetgen, SurvivesSurfacesThatMakeTetgenAbort) {
  // Flat, and open: neither passes check_surface, both go wrong in TetGen's own ways.
  const SurfaceSoup flat =
      soup_of({{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}, {Vec3{2, 0, 0}, Vec3{3, 1, 0}, Vec3{2, 1, 0}}});
  EXPECT_NE(tets_of(flat).failure, "");
  Facets facets = cube();
  facets.pop_back();
  const SurfaceSoup open = soup_of(facets);
  const Surface pretended{open, std::vector<std::int32_t>(11), {Shell{.behind = 1}}, 1};
  EXPECT_THAT(error_of_tets(pretended, tets_of(open)), HasSubstr("TetGen failed"));
}

TEST(RunTetgen, GivesUpInTime) {
  const Surface surface = oriented_shells_of(sphere({0, 0, 0}, 1, 100));
  EXPECT_THAT(tets_of(surface, {}, 0.001).failure, HasSubstr("longer than --tetgen-timeout"));
}

// A failure of the surface would be tried again in another order, or taken for a reason to keep another mesh.
TEST(RunTetgen, TellsOfMissingMemoryAtOnce) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer's shadow memory is over any limit";
#else
  const Surface surface = oriented_shells_of(sphere({0, 0, 0}, 1, 250));
  rlimit limit;
  ASSERT_EQ(getrlimit(RLIMIT_AS, &limit), 0);
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlimit less{pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + (60u << 20), limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_AS, &less), 0);
  std::string message;
  try {
    tets_of(surface);
  } catch (const DataError& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_AS, &limit);
  EXPECT_THAT(message, HasSubstr("not enough memory"));
#endif
}

TEST(BuildMesh, NoticesWhatTetgenMightDoWrong) {
  const Surface surface = oriented_shells_of(cube(0, 4, 4));
  const std::vector<Vec3> points{{2.1, 2, 2}, {1, 1, 1.2}};
  const TetGenResult good = tets_of(surface, points);
  EXPECT_EQ(error_of_tets(surface, good, points), "no error");

  TetGenResult moved = good;
  moved.points[3].x += 1e-9;
  EXPECT_THAT(error_of_tets(surface, moved, points), HasSubstr("it moved or merged points"));

  TetGenResult inverted_tet = good;
  std::swap(inverted_tet.tets[5][0], inverted_tet.tets[5][1]);
  EXPECT_THAT(error_of_tets(surface, inverted_tet, points), HasSubstr("1 of its"));

  TetGenResult lost = good;
  const Triangle at_surface = surface.triangles[7];
  std::erase_if(lost.tets, [&](const Tet& t) {
    return std::ranges::all_of(at_surface, [&](Vertex v) { return std::ranges::find(t, v) != t.end(); });
  });
  EXPECT_THAT(error_of_tets(surface, lost, points), HasSubstr("part: triangle 8: TetGen failed: it lost"));

  TetGenResult gap = good;
  const auto inner = static_cast<Vertex>(surface.points.size());
  std::erase_if(gap.tets,
                [&](const Tet& t) { return std::ranges::count_if(t, [&](Vertex v) { return v >= inner; }) == 2; });
  ASSERT_LT(gap.tets.size(), good.tets.size());
  EXPECT_THAT(error_of_tets(surface, gap, points), HasSubstr("TetGen failed: its tets leave a gap"));

  TetGenResult none = good;
  none.tets.clear();
  EXPECT_THAT(error_of_tets(surface, none, points), HasSubstr("it lost 192 triangles"));
}

TEST(BuildMesh, CountsPointsThatCameAndWent) {
  const Surface surface = oriented_shells_of(cube(0, 4, 4));
  const std::vector<Vec3> points{{2.1, 2, 2}, {9, 9, 9}, {1, 1, 1.2}};
  EXPECT_EQ(build_mesh(surface, points, tets_of(surface, points)).dropped_points, 1u);
  const std::vector<Vec3> one{points[0]};
  EXPECT_EQ(build_mesh(surface, one, tets_of(surface, points)).added_points, 1u);
}

}  // namespace
}  // namespace hexpipe
