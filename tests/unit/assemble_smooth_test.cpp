#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "assemble_lattice.hpp"
#include "cell_shapes.hpp"
#include "common/mesh/adjacency.hpp"
#include "common/mesh/quality.hpp"
#include "tests/unit/random_cases.hpp"
#include "tools/assemble/assemble.hpp"
#include "tools/assemble/conform/flat_tets.hpp"
#include "tools/assemble/shape/point_star.hpp"
#include "tools/assemble/shape/smooth.hpp"

namespace hexpipe {
using namespace assemble::conform;
using namespace assemble;
using namespace assemble::hybrid;
using namespace assemble::shape;
using namespace graph;
namespace {

using testing::jitter;
using testing::make_lattice;
using testing::random_choice;

Vec3 random_point(Random& random) {
  return {random.uniform(), random.uniform(), random.uniform()};
}

TEST(PointStar, GradientsAreThoseOfTheValues) {
  Random random(3);
  for (CellKind kind : all_kinds)
    for (int moving = 0; moving < corner_count(kind); ++moving) {
      std::vector<Vec3> corners;
      for (int i = 0; i < corner_count(kind); ++i) corners.push_back(random_point(random));
      PointStar star;
      star.add(kind, corners, moving);
      ASSERT_GT(star.size(), 0u);
      const Vec3 at = corners[moving];
      std::vector<Vec3> gradients;
      star.find_gradients(at, gradients);
      ASSERT_EQ(gradients.size(), star.size());
      constexpr double h = 1e-6;
      for (const Vec3& d : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        std::vector<double> ahead, behind;
        star.find_values(at + d * h, ahead);
        star.find_values(at - d * h, behind);
        for (std::size_t i = 0; i < star.size(); ++i)
          EXPECT_NEAR(dot(gradients[i], d), (ahead[i] - behind[i]) / (2 * h), 1e-6);
      }
    }
}

// Corners are measured several at a time, those with one formula together.
TEST(PointStar, EachCornerHasTheValueThatItHasAlone) {
  Random random(6);
  PointStar star;
  std::vector<double> values, expected;
  std::vector<Vec3> gradients, expected_gradients;
  const Vec3 at = random_point(random);
  for (int element = 0; element < 40; ++element) {
    const CellKind kind = all_kinds[element % all_kinds.size()];
    std::vector<Vec3> corners;
    for (int i = 0; i < corner_count(kind); ++i) corners.push_back(random_point(random));
    const int moving = element % corner_count(kind);
    const CornerRules rules{.weight = 0.5 + 0.01 * element};
    PointStar alone;
    alone.add(kind, corners, moving, rules);
    alone.find_values(at, values);
    expected.insert(expected.end(), values.begin(), values.end());
    alone.find_gradients(at, gradients);
    expected_gradients.insert(expected_gradients.end(), gradients.begin(), gradients.end());
    star.add(kind, corners, moving, rules);
    star.find_values(at, values);
    EXPECT_EQ(values, expected);
    star.find_gradients(at, gradients);
    EXPECT_EQ(gradients, expected_gradients);
    EXPECT_EQ(star.worst(at), std::ranges::min(expected));
  }
  star.clear();
  star.find_values(at, values);
  EXPECT_TRUE(values.empty());
}

// On the moving corner, and with edges without a length.
TEST(PointStar, CornersWithoutALengthHaveTheValueZero) {
  PointStar star;
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  star.add(CellKind::tet, corners, 3);
  std::vector<double> values;
  star.find_values(corners[0], values);
  ASSERT_EQ(values.size(), 4u);
  for (const double value : values) EXPECT_EQ(value, 0);
  std::vector<Vec3> gradients;
  star.find_gradients(corners[0], gradients);
  for (const Vec3& gradient : gradients) EXPECT_TRUE(norm(gradient) < 2);
}

TEST(PointStar, AgreesWithTheQualityOfCells) {
  Random random(4);
  for (CellKind kind : {CellKind::hex, CellKind::prism, CellKind::pyramid}) {
    std::vector<Vec3> corners;
    for (int i = 0; i < corner_count(kind); ++i) corners.push_back(random_point(random));
    // Over all moving corners every corner of the cell takes part.
    double least = 1;
    for (int moving = 0; moving < corner_count(kind); ++moving) {
      PointStar star;
      star.add(kind, corners, moving);
      least = std::min(least, star.worst(corners[moving]));
    }
    EXPECT_NEAR(least, least_corner_scaled_jacobian(kind, corners), 1e-12);
  }
}

// A unit cube one of whose corners moves away from its place along the diagonal.
TEST(PointStar, KeepsFloors) {
  std::array<Vec3, 8> cube{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  PointStar star, free;
  star.add(CellKind::hex, cube, 0, {.weight = 0.5, .floor = 0.3});
  free.add(CellKind::hex, cube, 0, {.weight = 0.5});
  const Vec3 home{}, slight{0.2, 0.2, 0.2}, far{0.4, 0.4, 0.4}, further{0.5, 0.5, 0.5};
  ASSERT_GT(star.measured(slight).worst_unweighted, 0.3);
  ASSERT_LT(star.measured(far).worst_unweighted, 0.3);
  EXPECT_TRUE(star.keeps_floors(home, slight));
  EXPECT_FALSE(star.keeps_floors(home, far));
  EXPECT_FALSE(star.keeps_floors(far, further));
  EXPECT_TRUE(star.keeps_floors(further, far));  // better, though not good
  EXPECT_TRUE(free.keeps_floors(home, far));
}

// The corner of a cube between seven others goes where it is pulled, and no further than the floor lets it.
TEST(PointStar, ScoreCountsThePull) {
  PointStar star;
  for (int octant = 0; octant < 8; ++octant) {
    std::vector<Vec3> cube;
    for (const Vec3& p : unit_cell(CellKind::hex))
      cube.push_back(p - Vec3{octant & 1 ? 1. : 0., octant & 2 ? 1. : 0., octant & 4 ? 1. : 0.});
    const auto middle = std::ranges::find(cube, Vec3{}) - cube.begin();
    star.add(CellKind::hex, cube, static_cast<int>(middle));
  }
  ASSERT_EQ(star.worst({}), 1);
  EXPECT_EQ(star.score_of(star.measured({})), 1);
  EXPECT_EQ(raise_score(star, star.measured({}), 5, 0.5).at, Vec3{});
  star.set_pull({}, {0.1, 0, 0});
  EXPECT_EQ(star.score_of(star.measured({})), 1);
  const Placement slight = raise_score(star, star.measured({}), 5, 0.5);
  EXPECT_GT(slight.at.x, 0.01);
  EXPECT_GT(star.score_of(star.measured(slight.at)), 1);
  star.set_pull({}, {10, 0, 0});
  for (const double floor : {0.5, 0.8, 0.9}) {
    const Placement far = raise_score(star, star.measured({}), 200, floor);
    EXPECT_GE(far.worst, floor);
    EXPECT_LT(far.worst, floor + 0.1);
    EXPECT_EQ(far.worst, star.worst(far.at));
  }
  EXPECT_EQ(raise_score(star, star.measured({}), 20, 0.5, {Freedom::Kind::plane, {1, 0, 0}}).at, Vec3{});
}

TEST(PointStar, ShortestVectorOfAHull) {
  const std::vector<Vec3> around{{1, 0, 0}, {-1, 0, 0}, {0, 1, 1}};
  EXPECT_NEAR(norm(shortest_in_hull(around)), 0, 1e-9);
  const std::vector<Vec3> ahead{{1, 1, 0}, {1, -1, 0}, {3, 0, 5}};
  const Vec3 shortest = shortest_in_hull(ahead);
  EXPECT_NEAR(shortest.x, 1, 1e-2);
  EXPECT_NEAR(shortest.y, 0, 1e-2);
}

TEST(PointStar, TheDeepestPointIsInTheKernel) {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    // Planes around a random point, at random distances from it; the start is anywhere.
    const Vec3 inside = random_point(random);
    std::vector<Plane> planes;
    double room = 1;
    for (int i = 0; i < 12; ++i) {
      const Vec3 direction = random_point(random) - random_point(random);
      const Vec3 normal = direction * (1 / norm(direction));
      const double distance = random.uniform(0.01, 1);
      planes.push_back({normal, dot(normal, inside) - distance});
      room = std::min(room, distance);
    }
    const Vec3 start = 3 * random_point(random);
    const Vec3 found = deepest_point(planes, start);
    double least = 1;
    for (const auto& plane : planes) least = std::min(least, plane.distance(found));
    EXPECT_GT(least, 0.9 * room) << "trial " << trial;
  }
}

// Eight tets around the origin of an octahedron: the middle is best, by symmetry.
TEST(PointStar, TheBestPlaceInAnOctahedronIsItsMiddle) {
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  PointStar star;
  for (int sx : {-1, 1})
    for (int sy : {-1, 1})
      for (int sz : {-1, 1}) {
        std::array<Vec3, 4> tet{sx * x, sy * y, sz * z, Vec3{}};
        if (det(tet[1] - tet[0], tet[2] - tet[0], tet[3] - tet[0]) < 0) std::swap(tet[0], tet[1]);
        star.add(CellKind::tet, tet, 3);
      }
  const Placement best = raise_worst(star, {0.4, -0.3, 0.45}, 100);
  EXPECT_NEAR(norm(best.at), 0, 0.02);
  // Held in the plane z = 0.2, and on a line in it.
  const Placement held = raise_worst(star, {0.4, -0.3, 0.2}, 100, {Freedom::Kind::plane, {0, 0, 1}});
  EXPECT_EQ(held.at.z, 0.2);
  EXPECT_NEAR(held.at.x, 0, 0.05);
  const Placement on_line = raise_worst(star, {0.4, -0.3, 0.2}, 100, {Freedom::Kind::line, {1, 0, 0}});
  EXPECT_EQ(on_line.at.y, -0.3);
  EXPECT_EQ(raise_worst(star, {0.4, -0.3, 0.2}, 100, {Freedom::Kind::none, {}}).at, (Vec3{0.4, -0.3, 0.2}));
}

TEST(Freedom, SidesEdgesAndCornersOfABox) {
  const auto lattice = make_lattice(2);
  const auto mesh =
      assemble::assemble(lattice.mesh, lattice.cubes, {0, 1, 2}, {.merge = assemble::AssembleOptions::Merge::none})
          .mesh;
  const auto freedoms = vertex_freedoms(mesh);
  std::array<int, 4> found{};
  for (std::size_t v = 0; v < 27; ++v) ++found[static_cast<int>(freedoms[v].kind)];
  EXPECT_EQ(found, (std::array{1, 6, 12, 8}));
}

TEST(Freedom, BordersOfTagsHold) {
  const auto lattice = make_lattice(2);
  auto mesh = assemble::assemble(lattice.mesh, lattice.cubes, {0, 1, 2, 3, 4, 5, 6, 7}, {}).mesh;
  const auto side = static_cast<std::size_t>(testing::lattice_vertex(2, 0, 1, 1));
  EXPECT_EQ(vertex_freedoms(mesh)[side].kind, Freedom::Kind::plane);
  for (std::size_t i = 0; i < mesh.quads.size(); ++i)
    if (mesh.quads.cells[i][0] == static_cast<Vertex>(side)) mesh.quads.tags[i] = 3;
  for (std::size_t i = 0; i < mesh.quads.size(); ++i) mesh.quads.tags[i] = static_cast<std::int32_t>(i);
  EXPECT_EQ(vertex_freedoms(mesh)[side].kind, Freedom::Kind::none);
}

TEST(Smooth, TheWorstCellsBecomeBetterAndTheBoxStays) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = make_lattice(5);
    jitter(lattice, 0.2, random);
    const auto chosen = random_choice(lattice, 0.7, random);
    const auto rough = assemble::assemble(lattice.mesh, lattice.cubes, chosen, {.smooth = 0});
    MixedMesh mesh = rough.mesh;
    const SmoothCounts counts = smooth(mesh, 5);
    EXPECT_GT(counts.moves, 0);
    compute_quality(mesh);
    const auto statistics = kind_statistics(mesh);
    double before = 1, after = 1;
    for (std::size_t k = 0; k < all_kinds.size(); ++k) {
      if (statistics[k].count == 0) continue;
      before = std::min(before, rough.statistics.kinds[k].least);
      after = std::min(after, statistics[k].least);
    }
    EXPECT_GT(after, before);
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      for (int axis = 0; axis < 3; ++axis) {
        if (rough.mesh.points[v][axis] == 0) {
          EXPECT_EQ(mesh.points[v][axis], 0);
        }
      }
  }
}

// smooth() passes over vertices whose cells are above 0.9; with small jitter all are.
TEST(Smooth, PolishingMakesGoodHexesBetter) {
  Random random(1);
  auto lattice = make_lattice(5);
  jitter(lattice, 0.08, random);
  MixedMesh mesh =
      assemble::assemble(lattice.mesh, lattice.cubes, random_choice(lattice, 1, random), {.smooth = 0}).mesh;
  // The least and the mean.
  const auto quality = [&] {
    compute_quality(mesh);
    const std::vector<double>& of = mesh.hexes.quality;
    return std::pair(std::ranges::min(of), std::accumulate(of.begin(), of.end(), 0.0) / static_cast<double>(of.size()));
  };
  const auto [least_before, mean_before] = quality();
  ASSERT_GT(least_before, 0.9);
  EXPECT_EQ(smooth(mesh, 5).moves, 0);
  EXPECT_GT(polish(mesh, 3).moves, 0);
  const auto [least, mean] = quality();
  EXPECT_GT(mean, mean_before + 0.5 * (1 - mean_before));
  EXPECT_GT(least, least_before);
}

// Cells between hexes become thin to make room for them, but none becomes poor.
TEST(Smooth, HexesGrowAndTheRestStaysGoodEnough) {
  constexpr double good_enough = 0.12;
  double grown = 0, thinner = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = make_lattice(5);
    jitter(lattice, 0.1, random);
    MixedMesh mesh =
        assemble::assemble(lattice.mesh, lattice.cubes, random_choice(lattice, 0.7, random), {.smooth = 0}).mesh;
    const auto volume_of_hexes = [&] {
      double volume = 0;
      for (const auto& hex : mesh.hexes.cells) volume += cell_volume(CellKind::hex, corner_points(mesh.points, hex));
      return volume;
    };
    untangle(mesh, 20);
    compute_quality(mesh);
    const std::vector<double> before = mesh.pyramids.quality;
    const double volume_before = volume_of_hexes();
    smooth(mesh, 5);
    compute_quality(mesh);
    grown += volume_of_hexes() - volume_before;
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_GE(mesh.pyramids.quality[i], std::min(before[i], good_enough) - 2 * quality_tolerance);
      thinner += mesh.pyramids.quality[i] < before[i] - 0.02;
    }
  }
  EXPECT_GT(grown, 1);
  EXPECT_GT(thinner, 0);
}

// What is beside the hexes is flat.
auto make_flat_lattice(double most_jitter, Random& random) {
  auto lattice = make_lattice(5);
  jitter(lattice, most_jitter, random);
  for (Vec3& at : lattice.mesh.points) at.x *= 4;
  return lattice;
}

// Pyramids and tets beside them become better at the cost of hexes, but not below what findhex asks of these.
TEST(Smooth, HexesKeepAScaledJacobianOfThreeTenths) {
  double least = 1;
  constexpr std::uint64_t seeds = hexpipe::testing::random_cases(20);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto lattice = make_flat_lattice(0.2, random);
    IndependentSet chosen = random_choice(lattice, 0.6, random);
    std::erase_if(chosen, [&](std::int32_t c) {
      const auto corners = corner_points(lattice.mesh.points, lattice.cubes.vertices[c]);
      return least_corner_scaled_jacobian(CellKind::hex, corners) < 0.3;
    });
    const auto result = assemble::assemble(lattice.mesh, lattice.cubes, chosen, {.smooth = 10});
    EXPECT_GE(result.statistics.kinds[0].least, 0.3 - 1e-9);
    least = std::min(least, result.statistics.kinds[0].least);
  }
  EXPECT_LT(least, 0.35);
}

// Prisms stand in columns between hexes, which may not press them flat, as they do with pyramids and tets.
TEST(Smooth, PrismsKeepAScaledJacobianOfThreeTenths) {
  constexpr double least_prism = 0.3;
  double least = 1;
  constexpr std::uint64_t seeds = hexpipe::testing::random_cases(20);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto lattice = make_flat_lattice(0.15, random);
    MixedMesh mesh =
        assemble::assemble(lattice.mesh, lattice.cubes, random_choice(lattice, 0.7, random), {.smooth = 0}).mesh;
    untangle(mesh, 20);
    compute_quality(mesh);
    const std::vector<double> before = mesh.prisms.quality;
    smooth(mesh, 10);
    compute_quality(mesh);
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_GE(mesh.prisms.quality[i], std::min(before[i], least_prism) - 2 * quality_tolerance) << "prism " << i;
      least = std::min(least, mesh.prisms.quality[i]);
    }
  }
  EXPECT_LT(least, 0.35);
}

// A vertex pulled through the cells around it.
TEST(Smooth, UntangleTurnsInvertedCellsRight) {
  const auto lattice = make_lattice(3);
  auto mesh = assemble::assemble(lattice.mesh, lattice.cubes, {0, 1, 2, 9, 10, 11}, {.smooth = 0}).mesh;
  mesh.points[static_cast<std::size_t>(testing::lattice_vertex(3, 1, 1, 1))] = {1.2, 1.3, 2.3};
  compute_quality(mesh);
  EXPECT_LT(kind_statistics(mesh)[0].least, 0);
  untangle(mesh, 20);
  compute_quality(mesh);
  for (const auto& kind : kind_statistics(mesh)) EXPECT_GE(kind.least, 0.0);
  EXPECT_GT(kind_statistics(mesh)[0].least, 0.02);
}

// Scaled Jacobians are the same however short an edge is.
TEST(Smooth, EdgesStayLong) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto lattice = make_lattice(4);
    jitter(lattice, 0.2, random);
    const auto mesh =
        assemble::assemble(lattice.mesh, lattice.cubes, random_choice(lattice, 0.7, random), {.smooth = 20}).mesh;
    double shortest = 1, longest = 0;
    auto measure = [&](const auto& cells, const auto& edges) {
      for (const auto& cell : cells)
        for (const auto& e : edges) {
          const double length = norm(mesh.points[cell[e[1]]] - mesh.points[cell[e[0]]]);
          shortest = std::min(shortest, length);
          longest = std::max(longest, length);
        }
    };
    measure(mesh.hexes.cells, HexTopology::edges);
    measure(mesh.pyramids.cells, PyramidTopology::edges);
    measure(mesh.tets.cells, TetTopology::edges);
    EXPECT_GT(shortest, 0.05 * longest);
  }
}

// The option goes all the way: more rounds, other places; statistics tell of both states.
TEST(Smooth, RoundsChangeTheResult) {
  Random random(1);
  auto lattice = make_lattice(4);
  jitter(lattice, 0.2, random);
  const auto chosen = random_choice(lattice, 0.7, random);
  const auto once =
      assemble::assemble(lattice.mesh, lattice.cubes, chosen, {.merge = AssembleOptions::Merge::none, .smooth = 1});
  const auto often =
      assemble::assemble(lattice.mesh, lattice.cubes, chosen, {.merge = AssembleOptions::Merge::none, .smooth = 5});
  EXPECT_NE(once.mesh.points, often.mesh.points);
  EXPECT_EQ(once.statistics.improvement.rounds, 2) << "one and one more to polish";
  EXPECT_GT(often.statistics.kinds[3].least, often.statistics.before_smoothing[3].least);
  EXPECT_NEAR(often.statistics.volumes.cells, 64, 1e-9);
}

// A box of 2 x 2 x 2 cubes without a vertex in its middle but one close to a corner: the tets there are flat, and a
// vertex of its own where there is room makes the worst of them better.
TEST(Split, AVertexBesideFlatTets) {
  auto lattice = make_lattice(2);
  TetMesh& mesh = lattice.mesh;
  mesh.points[static_cast<std::size_t>(testing::lattice_vertex(2, 1, 1, 1))] = {1, 1, 1.95};
  add_missing_boundary_triangles(mesh, TetAdjacency(mesh, "test"), 0);
  const SurfaceTags tags(mesh);
  HybridMesh hybrid(mesh, std::vector<bool>(mesh.tets.size(), false));
  auto worst_tet = [&] {
    double worst = 1;
    for (const auto t : indices<TetIndex>(hybrid.tet_count())) {
      if (!hybrid.is_alive(t)) continue;
      const auto at = corner_points(hybrid.points, hybrid.tet(t));
      worst = std::min(worst, least_corner_scaled_jacobian(CellKind::tet, std::span<const Vec3>(at).first(4)));
    }
    return worst;
  };
  const double before = worst_tet();
  EXPECT_GT(split_flat_tets(hybrid, tags, 0.1), 0);
  EXPECT_GT(worst_tet(), before);
}

}  // namespace
}  // namespace hexpipe
