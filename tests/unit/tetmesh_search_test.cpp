#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>

#include "common/run/parallel.hpp"
#include "common/run/random.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/search/judged_mesh.hpp"
#include "tools/tetmesh/search/mesh_change.hpp"
#include "tools/tetmesh/search/point_search.hpp"
#include "tools/tetmesh/search/surface_change.hpp"
#include "tools/tetmesh/solid/surface_check.hpp"

namespace hexpipe {
using namespace formats;
using namespace tetmesh::search;
using namespace tetmesh::solid;
using namespace tetmesh::tetgen;
namespace {

constexpr int cells = 4;  // along each edge of the box, of size 1

Surface box_surface() {
  SurfaceSoup soup = testing::soup_of(testing::cube(0, cells, cells));
  // A tag for each side, which comes after the other.
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    soup.tags[t] = static_cast<std::int32_t>(1 + t / (2 * cells * cells));
  return find_shells(std::move(soup), ShellRule::oriented);
}

std::vector<Vec3> points_inside(double moved) {
  return testing::lattice_in_cube(cells, moved);
}

void fill_all(std::span<const SurfaceWithPoints> all, const TakeMesh& take) {
  for (std::size_t i = 0; i < all.size(); ++i) take(i, testing::mesh_of(all[i].surface, all[i].inside));
}

Vertex vertex_at(const Surface& surface, const Vec3& place) {
  return static_cast<Vertex>(std::ranges::find(surface.points, place) - surface.points.begin());
}

double area_of(const Surface& surface, std::size_t t) {
  const auto [a, b, c] = surface.triangles[t];
  const Vec3& o = surface.points[a];
  return norm(cross(surface.points[b] - o, surface.points[c] - o)) / 2;
}

// Closed, without intersections, the same box, each side with its tag.
void expect_same_box(const Surface& surface) {
  SurfaceSoup soup = surface;
  EXPECT_NO_THROW(check_surface(soup, ""));
  EXPECT_NEAR(surface.shells[0].volume, cells * cells * cells, 1e-9);
  std::array<double, 7> areas{};
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) areas[surface.tags[t]] += area_of(surface, t);
  for (int side = 1; side <= 6; ++side) EXPECT_NEAR(areas[side], cells * cells, 1e-9) << side;
}

Surface with(const Surface& surface, const SurfaceChange& change) {
  return with_changes(surface, std::vector<const SurfaceChange*>{&change});
}

TEST(FlatSurface, MovesPointsWithinFacesAlongEdgesAndNoCorners) {
  const Surface surface = box_surface();
  const FlatSurface flat(surface);
  const auto moved_to = [&](const Vec3& from) -> std::optional<Vec3> {
    const SurfaceChange change = flat.move(vertex_at(surface, from), {0.2, 0.2, 0.2}, 1);
    return change.moved ? std::optional(change.moved->second) : std::nullopt;
  };
  EXPECT_EQ(moved_to({1, 1, 0}), (Vec3{1.2, 1.2, 0}));
  EXPECT_EQ(moved_to({1, 0, 0}), (Vec3{1.2, 0, 0}));
  EXPECT_EQ(moved_to({0, 0, 0}), std::nullopt);
  // Over the next point, where triangles would turn over.
  EXPECT_TRUE(flat.move(vertex_at(surface, {1, 1, 0}), {1.5, 0, 0}, 1).is_nothing());
}

TEST(FlatSurface, LeavesPointsOfBentSurfacesAndBetweenTags) {
  const Surface round = find_shells(testing::soup_of(testing::sphere({0, 0, 0}, 1, 6)), ShellRule::oriented);
  const FlatSurface of_sphere(round);
  for (Vertex v = 0; v < static_cast<Vertex>(round.points.size()); ++v) {
    EXPECT_TRUE(of_sphere.move(v, {0.01, 0.01, 0.01}, 0.1).is_nothing());
    for (const Vertex w : of_sphere.neighbours_of(v)) EXPECT_TRUE(of_sphere.collapse(v, w, 0.1).is_nothing());
  }
  Surface tagged = box_surface();
  const Vertex v = vertex_at(tagged, {1, 1, 0});
  for (std::size_t t = 0; t < tagged.triangles.size(); ++t)
    if (std::ranges::count(tagged.triangles[t], v) > 0 && tagged.points[tagged.triangles[t][0]].z == 0) {
      tagged.tags[t] = 9;  // of one triangle alone: its corner is where two lines meet
      break;
    }
  EXPECT_TRUE(FlatSurface(tagged).move(v, {0.2, 0.2, 0}, 1).is_nothing());
}

TEST(FlatSurface, JoinsSplitsAndFlips) {
  const Surface surface = box_surface();
  const FlatSurface flat(surface);
  const Vertex a = vertex_at(surface, {1, 1, 0}), b = vertex_at(surface, {2, 1, 0});

  const Surface joined = with(surface, flat.collapse(a, b, 1));
  EXPECT_EQ(joined.points.size(), surface.points.size() - 1);
  EXPECT_EQ(joined.triangles.size(), surface.triangles.size() - 2);
  expect_same_box(joined);

  const Surface split = with(surface, flat.split(a, b, 1));
  EXPECT_EQ(split.points.size(), surface.points.size() + 1);
  EXPECT_EQ(split.points.back(), (Vec3{1.5, 1, 0}));
  expect_same_box(split);

  const Vertex across = vertex_at(surface, {2, 2, 0}), beside = vertex_at(surface, {0, 1, 0});
  const Surface flipped =
      with(surface, flat.flip(a, across, 1).is_nothing() ? flat.flip(a, beside, 1) : flat.flip(a, across, 1));
  EXPECT_EQ(flipped.points, surface.points);
  EXPECT_EQ(flipped.triangles.size(), surface.triangles.size());
  EXPECT_NE(flipped.triangles, surface.triangles);
  expect_same_box(flipped);

  // An edge of the box is no diagonal, and a point on it does not leave it.
  const Vertex on_edge = vertex_at(surface, {1, 0, 0}), next = vertex_at(surface, {2, 0, 0});
  EXPECT_TRUE(flat.flip(on_edge, next, 1).is_nothing());
  EXPECT_TRUE(flat.collapse(on_edge, a, 1).is_nothing());
  expect_same_box(with(surface, flat.collapse(on_edge, next, 1)));
}

TEST(FlatSurface, StaysTheSameBoxWhateverChanges) {
  Surface surface = box_surface();
  Random random(7);
  std::array<int, 4> done{};
  for (int i = 0; i < 400; ++i) {
    const FlatSurface flat(surface);
    const auto v = static_cast<Vertex>(random.below(surface.points.size()));
    const std::vector<Vertex> neighbours = flat.neighbours_of(v);
    const Vertex w = neighbours[random.below(neighbours.size())];
    const std::uint64_t kind = random.below(4);
    const Vec3 step{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4)};
    const SurfaceChange change = kind == 0   ? flat.move(v, step, 1)
                                 : kind == 1 ? flat.collapse(v, w, 1)
                                 : kind == 2 ? flat.split(v, w, 1)
                                             : flat.flip(v, w, 1);
    if (change.is_nothing()) continue;
    ++done[kind];
    surface = with(surface, change);
  }
  EXPECT_THAT(done, ::testing::Each(::testing::Gt(10)));
  expect_same_box(surface);
}

// The point nearest to a corner of the box moves.
std::vector<Vec3> one_moved(std::vector<Vec3> points, const Vec3& step) {
  points.front() += step;
  return points;
}

double distance_to_moved(const TetMesh& mesh, std::span<const Vertex> corners) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vertex v : corners) least = std::min(least, norm(mesh.points[v] - Vec3{1, 1, 1}));
  return least;
}

TEST(MeshChange, NothingIsTouchedWhereNothingChanged) {
  const TetMesh mesh = testing::mesh_of(box_surface(), points_inside(0.3)).mesh;
  const MeshChange change(MeshIndex(mesh), mesh);
  EXPECT_THAT(change.is_touched, ::testing::Each(false));
  for (std::size_t v = 0; v < mesh.points.size(); ++v) EXPECT_EQ(change.vertex_now[v], static_cast<Vertex>(v));
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) EXPECT_EQ(change.tet_now[t], static_cast<std::int32_t>(t));
}

TEST(MeshChange, FindsWhatStaysAndWhatIsTouched) {
  const Surface surface = box_surface();
  std::vector<Vec3> inside = points_inside(0.3);
  const TetMesh before = testing::mesh_of(surface, inside).mesh;
  // One moves, one goes: those behind it have another number.
  inside = one_moved(std::move(inside), {0.1, 0.1, 0.1});
  inside.erase(inside.begin() + 1);
  const TetMesh now = testing::mesh_of(surface, inside).mesh;
  const MeshChange change(MeshIndex(before), now);
  ASSERT_EQ(change.vertex_now.size(), before.points.size());
  EXPECT_EQ(std::ranges::count(change.vertex_now, no_index), 2);
  for (std::size_t v = 0; v < before.points.size(); ++v)
    if (change.vertex_now[v] != no_index) {
      EXPECT_EQ(now.points[change.vertex_now[v]], before.points[v]);
    }
  std::vector<bool> is_old(now.tets.size());
  for (std::size_t t = 0; t < before.tets.size(); ++t) {
    if (change.tet_now[t] == no_index) continue;
    is_old[change.tet_now[t]] = true;
    for (const Vertex v : before.tets[t])
      EXPECT_THAT(now.tets[change.tet_now[t]], ::testing::Contains(change.vertex_now[v]));
  }
  std::vector<bool> is_touched(now.points.size());
  for (std::size_t t = 0; t < now.tets.size(); ++t)
    for (const Vertex v : now.tets[t])
      if (!is_old[t]) is_touched[v] = true;
  for (std::size_t t = 0; t < before.tets.size(); ++t)
    for (const Vertex v : before.tets[t])
      if (change.tet_now[t] == no_index && change.vertex_now[v] != no_index) is_touched[change.vertex_now[v]] = true;
  EXPECT_EQ(change.is_touched, is_touched);
  const auto touched = std::ranges::count(is_touched, true);
  EXPECT_GT(touched, 10);
  EXPECT_LT(touched, static_cast<std::ptrdiff_t>(now.points.size() / 2));
}

using Places = std::vector<std::array<double, 3>>;

// The places of a hex's corners, which identify it across meshes.
Places places_of(const ChosenHex& hex, const TetMesh& mesh) {
  Places places;
  for (const Vertex v : hex.corners) places.push_back({mesh.points[v].x, mesh.points[v].y, mesh.points[v].z});
  std::ranges::sort(places);
  return places;
}

std::vector<Places> places_of(std::span<const ChosenHex> hexes, const TetMesh& mesh) {
  std::vector<Places> places;
  for (const ChosenHex& hex : hexes) places.push_back(places_of(hex, mesh));
  std::ranges::sort(places);
  return places;
}

// Hexes that share no tet, whose tets have their volume but for slivers.
void expect_hexes_of(const TetMesh& mesh, std::span<const ChosenHex> hexes) {
  std::vector<int> uses(mesh.tets.size());
  for (const ChosenHex& hex : hexes) {
    double volume = 0;
    ASSERT_GE(hex.interior_tets.size(), 5u);
    for (const TetIndex t : hex.interior_tets) {
      ++uses[t];
      volume += tet_determinant(mesh.points, mesh.tets[t]) / 6;
      for (const Vertex v : mesh.tets[t])
        EXPECT_TRUE(std::ranges::count(hex.corners, v) == 1 || hex.interior_tets.size() > 15);
    }
    EXPECT_NEAR(volume, hex.volume, 0.3 * hex.volume);
    EXPECT_GT(hex.quality, 0.3);
  }
  EXPECT_THAT(uses, ::testing::Each(::testing::Le(1)));
}

TEST(ChooseHexes, ChoosesTheSameAgainWhereNothingChanged) {
  const TetMesh mesh = testing::mesh_of(box_surface(), points_inside(0.3)).mesh;
  const std::vector<ChosenHex> found = choose_hexes(mesh, 20);
  ASSERT_GT(found.size(), 10u);
  expect_hexes_of(mesh, found);
  const std::vector<ChosenHex> again = choose_hexes_again(mesh, MeshChange(MeshIndex(mesh), mesh), found, 1);
  EXPECT_EQ(places_of(again, mesh), places_of(found, mesh));
  expect_hexes_of(mesh, again);
}

TEST(ChooseHexes, KeepsWhatIsFarFromAChange) {
  const Surface surface = box_surface();
  const TetMesh mesh = testing::mesh_of(surface, points_inside(0.3)).mesh;
  const std::vector<ChosenHex> found = choose_hexes(mesh, 20);
  const TetMesh changed = testing::mesh_of(surface, one_moved(points_inside(0.3), {0.1, 0.1, 0.1})).mesh;
  const std::vector<ChosenHex> again = choose_hexes_again(changed, MeshChange(MeshIndex(mesh), changed), found, 1);
  expect_hexes_of(changed, again);
  const std::vector<Places> places = places_of(again, changed);
  int far = 0;
  for (const ChosenHex& hex : found) {
    if (distance_to_moved(mesh, hex.corners) <= 3) continue;
    ++far;
    EXPECT_THAT(places, ::testing::Contains(places_of(hex, mesh)));
  }
  EXPECT_GT(far, 0);
}

// A cube of six tets with a sliver on its top, which goes without any tet in its place.
TEST(ChooseHexes, ForgetsASliverThatGoes) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1.001}, {1, 1, 1}, {0, 1, 1.001}};
  mesh.tets = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}, {4, 6, 5, 7}};
  for (Tet& tet : mesh.tets)
    if (tet_determinant(mesh.points, tet) < 0) std::swap(tet[0], tet[1]);
  mesh.tet_tags.assign(mesh.tets.size(), 1);
  const std::vector<ChosenHex> with_sliver = choose_hexes(mesh, 1);
  ASSERT_EQ(with_sliver.size(), 1u);
  ASSERT_EQ(with_sliver.front().boundary_tets, std::vector{TetIndex(6)});
  TetMesh without = mesh;
  without.tets.pop_back();
  without.tet_tags.pop_back();
  const MeshChange change(MeshIndex(mesh), without);
  EXPECT_EQ(change.is_touched, (std::vector<bool>{false, false, false, false, true, true, true, true}));
  const std::vector<ChosenHex> again = choose_hexes_again(without, change, with_sliver, 1);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_TRUE(again.front().boundary_tets.empty());
  EXPECT_EQ(again.front().interior_tets.size(), 6u);
}

// As good as from nothing, apart from chance: on the whole box, most of which the changes touch.
TEST(ChooseHexes, FindsTheHexesOfWhatChanged) {
  const Surface surface = box_surface();
  const TetMesh mesh = testing::mesh_of(surface, points_inside(0.8)).mesh;
  const std::vector<ChosenHex> found = choose_hexes(mesh, 20);
  const TetMesh changed = testing::mesh_of(surface, points_inside(0.01)).mesh;
  const std::vector<ChosenHex> again = choose_hexes_again(changed, MeshChange(MeshIndex(mesh), changed), found, 1);
  EXPECT_EQ(again.size(), static_cast<std::size_t>(cells * cells * cells));
  EXPECT_EQ(places_of(again, changed), places_of(choose_hexes(changed, 20), changed));
}

JudgedMesh judged(BuiltMesh built) {
  std::vector<ChosenHex> hexes = choose_hexes(built.mesh, 20);
  return judge(std::move(built), std::move(hexes));
}

TEST(JudgedMesh, HexesWithOpenQuadsAreWorthLess) {
  const Surface surface = box_surface();
  const JudgedMesh whole = judged(testing::mesh_of(surface, points_inside(0.01)));
  EXPECT_EQ(whole.hexes.size(), static_cast<std::size_t>(cells * cells * cells));
  EXPECT_TRUE(whole.left.empty());
  EXPECT_NEAR(whole.total_worth(), whole.hex_volume(), 1e-9);
  EXPECT_NEAR(whole.hex_volume(), cells * cells * cells, 1e-3);
  const JudgedMesh partly = judged(testing::mesh_of(surface, points_inside(0.8)));
  EXPECT_FALSE(partly.left.empty());
  EXPECT_LT(partly.total_worth(), partly.hex_volume() - 0.1);
  for (const TetIndex t : partly.left) EXPECT_EQ(partly.hex_of_tet[t], no_index);
}

TEST(PointSearch, BringsHexesAndIsTheSameForAnyThreads) {
  const Surface surface = box_surface();
  const auto search = [&](bool changes_surface, std::size_t rounds, const Deadline& deadline) {
    return search_points(surface, testing::mesh_of(surface, points_inside(0.8)),
                         {.size = 1, .seed = 3, .rounds = rounds, .changes_surface = changes_surface}, deadline,
                         fill_all);
  };
  for (const bool changes_surface : {false, true}) {
    const PointSearchResult found = search(changes_surface, 10, Deadline());
    const PointSearchResult again = [&] {
      const ThreadLimit one_thread(1);
      return search(changes_surface, 10, Deadline());
    }();
    EXPECT_EQ(found.summary.rounds, 10u);
    EXPECT_GE(found.summary.changes, 5u);
    EXPECT_GT(found.summary.share, found.summary.share_before + 0.02);
    EXPECT_LE(found.summary.share, 1 + 1e-9);
    EXPECT_TRUE(found.built.mesh == again.built.mesh);
    EXPECT_EQ(found.surface.has_value(), changes_surface);
    const Surface& result = found.surface ? *found.surface : surface;
    EXPECT_EQ(result.points == surface.points && result.triangles == surface.triangles, !changes_surface);
    expect_same_box(result);
    // The share is that of the mesh that comes out.
    const JudgedMesh from_nothing =
        judged(testing::mesh_of(result, std::span(found.built.mesh.points).subspan(result.points.size())));
    EXPECT_NEAR(from_nothing.hex_volume() / (cells * cells * cells), found.summary.share, 0.05);
  }
  const PointSearchResult none = search(true, 20, Deadline(0));
  EXPECT_EQ(none.summary.rounds, 0u);
  EXPECT_EQ(none.summary.share, none.summary.share_before);
  EXPECT_EQ(none.built.mesh, testing::mesh_of(surface, points_inside(0.8)).mesh);
}

TEST(PointSearch, PassesOverMeshesThatCannotBeMade) {
  const Surface surface = box_surface();
  const BuiltMesh start = testing::mesh_of(surface, points_inside(0.8));
  const PointSearchResult found =
      search_points(surface, testing::mesh_of(surface, points_inside(0.8)), {.size = 1, .seed = 3, .rounds = 3},
                    Deadline(), [](std::span<const SurfaceWithPoints>, const TakeMesh&) {});
  EXPECT_EQ(found.summary.rounds, 3u);
  EXPECT_EQ(found.summary.changes, 0u);
  EXPECT_EQ(found.built.mesh, start.mesh);
}

}  // namespace
}  // namespace hexpipe
