#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "assemble_lattice.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"
#include "common/run/error.hpp"
#include "tools/assemble/assemble.hpp"
#include "tools/assemble/hybrid/cell_facets.hpp"
#include "tools/assemble/layers/columns.hpp"
#include "tools/assemble/layers/guide_surface.hpp"
#include "tools/assemble/layers/line_plan.hpp"
#include "tools/assemble/layers/wall_choice.hpp"
#include "tools/assemble/layers/walls.hpp"

namespace hexpipe {
using namespace assemble;
using namespace assemble::layers;
namespace {

using ::testing::HasSubstr;
using testing::Lattice;
using testing::lattice_vertex;
using testing::make_lattice;

enum Side : std::int32_t { low_i = 1, high_i, low_j, high_j, low_k, high_k };

// Tags the boundary of the cubes that `has` keeps, by the way it faces; the other cubes are gone.
Lattice tagged_lattice(
    int n, const std::function<bool(int, int, int)>& has = [](int, int, int) { return true; },
    const std::function<int(int, int, int)>& region = [](int, int, int) { return 1; }) {
  const Lattice whole = make_lattice(n, region);
  Lattice lattice{n, {}, {}};
  lattice.mesh.points = whole.mesh.points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        if (!has(i, j, k)) continue;
        const std::size_t cube = static_cast<std::size_t>((i * n + j) * n + k);
        for (std::size_t t = 6 * cube; t < 6 * cube + 6; ++t) {
          lattice.cubes.tets.emplace_back(lattice.mesh.tets.size());
          lattice.mesh.tets.push_back(whole.mesh.tets[t]);
          lattice.mesh.tet_tags.push_back(whole.mesh.tet_tags[t]);
        }
        lattice.cubes.vertices.push_back(whole.cubes.vertices[cube]);
        lattice.cubes.kind.push_back(CellKind::hex);
        lattice.cubes.quality.push_back(1);
        lattice.cubes.volume.push_back(1);
        lattice.cubes.tet_offsets.push_back(static_cast<std::int64_t>(lattice.cubes.tets.size()));
        lattice.cubes.boundary_tet_offsets.push_back(0);
      }
  TetMesh& mesh = lattice.mesh;
  add_missing_boundary_triangles(mesh, TetAdjacency(mesh, "lattice"), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 normal = cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
    for (int axis = 0; axis < 3; ++axis)
      if (normal[axis] != 0) mesh.triangle_tags[t] = 1 + 2 * axis + (normal[axis] > 0);
  }
  return lattice;
}

LayerOptions options_with(std::vector<AskedWall> walls, double first_height, double growth = 1.2) {
  LayerOptions options;
  options.walls = std::move(walls);
  options.first_height = first_height;
  options.growth = growth;
  return options;
}

AssembleResult with_layers(const Lattice& lattice, const LayerOptions& options) {
  graph::IndependentSet all(lattice.cubes.size());
  std::iota(all.begin(), all.end(), 0);
  return assemble::assemble(lattice.mesh, lattice.cubes, all, {}, {}, options);
}

template <class Call>
std::string message_from(Call&& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

// What self_check.hpp proves, told again from the cells.
double expect_sound(const MixedMesh& mesh) {
  double volume = 0;
  hybrid::for_each_cell(mesh, [&](CellKind kind, std::span<const Vertex> corners, std::int32_t) {
    const auto at = corner_points(mesh.points, corners);
    const auto cell = std::span<const Vec3>(at).first(corners.size());
    EXPECT_TRUE(is_valid(kind, cell));
    volume += cell_volume(kind, cell);
  });
  hybrid::CellFacets facets(mesh);
  std::size_t outer = 0, tagged_twice = 0;
  for (const auto& facet : facets.entries()) {
    EXPECT_LE(facet.uses, 2);
    EXPECT_FALSE(facet.one_way);
    if (facet.uses == 1)
      ++outer;
    else if (facet.regions[0] != facet.regions[1])
      ++tagged_twice;
  }
  EXPECT_EQ(outer + tagged_twice, mesh.triangles.size() + mesh.quads.size());
  return volume;
}

TEST(Layers, StandOnOneSideOfABox) {
  constexpr int n = 4, layers = 3;
  const Lattice box = tagged_lattice(n);
  const AssembleResult result = with_layers(box, options_with({{"5", layers}}, 0.05));
  EXPECT_NEAR(expect_sound(result.mesh), n * n * n, 1e-9);
  EXPECT_EQ(result.mesh.hexes.size(), static_cast<std::size_t>(n * n * n + layers * n * n));
  EXPECT_EQ(result.mesh.points.size(), static_cast<std::size_t>((n + 1) * (n + 1) * (n + 1 + layers)));
  // Four sides get a row of quads for each layer.
  EXPECT_EQ(result.mesh.quads.size(), static_cast<std::size_t>(6 * n * n + 4 * layers * n));
  ASSERT_TRUE(result.statistics.layers);
  EXPECT_EQ(result.statistics.layers->area, n * n);
  EXPECT_EQ(result.statistics.layers->area_with_all, n * n);
  EXPECT_NEAR(result.statistics.layers->least_quality, 1, 1e-9);
}

TEST(Layers, HaveTheFirstHeightAndGrow) {
  const Lattice box = tagged_lattice(3);
  const AssembleResult result = with_layers(box, options_with({{"5", 3}}, 0.05, 2));
  // Over the vertex at the corner of the floor.
  std::vector<double> heights;
  for (const Vec3& p : result.mesh.points)
    if (p.x == 0 && p.y == 0 && p.z < 0.5) heights.push_back(p.z);
  std::ranges::sort(heights);
  ASSERT_EQ(heights.size(), 4u);
  EXPECT_EQ(heights[0], 0);
  EXPECT_NEAR(heights[1], 0.05, 1e-12);
  EXPECT_NEAR(heights[2], 0.15, 1e-12);
  EXPECT_NEAR(heights[3], 0.35, 1e-12);
}

TEST(Layers, MeetAtTheEdgesAndCornersOfABox) {
  constexpr int n = 4, layers = 2;
  const AssembleResult result = with_layers(tagged_lattice(n), options_with({{"all", layers}}, 0.1));
  EXPECT_NEAR(expect_sound(result.mesh), n * n * n, 1e-9);
  EXPECT_EQ(result.mesh.hexes.size(), static_cast<std::size_t>(n * n * n + 6 * layers * n * n));
  EXPECT_EQ(result.mesh.quads.size(), static_cast<std::size_t>(6 * n * n));
  EXPECT_EQ(result.statistics.layers->area_with_all, 6 * n * n);
  EXPECT_GT(result.statistics.layers->least_quality, 0.5);
}

// Around the edge inside, where the walls turn away from each other.
TEST(Layers, GoRoundTheInnerEdgeOfAnL) {
  constexpr int n = 4;
  const Lattice l = tagged_lattice(n, [](int i, int j, int) { return i < 2 || j < 2; });
  const AssembleResult result = with_layers(l, options_with({{"all", 3}}, 0.05));
  EXPECT_NEAR(expect_sound(result.mesh), 48, 1e-9);
  EXPECT_EQ(result.statistics.layers->area_with_layers, result.statistics.layers->area);
  EXPECT_NEAR(result.statistics.layers->area_with_all, result.statistics.layers->area, 1e-9);
}

// A corner at which three walls turn inwards, and edges of both kinds around it.
TEST(Layers, GoRoundACornerThatPointsInwards) {
  constexpr int n = 4;
  const Lattice notched = tagged_lattice(n, [](int i, int j, int k) { return i < 2 || j < 2 || k < 2; });
  const AssembleResult result = with_layers(notched, options_with({{"all", 3}}, 0.05));
  EXPECT_NEAR(expect_sound(result.mesh), 56, 1e-9);
  EXPECT_EQ(result.statistics.layers->area_with_layers, result.statistics.layers->area);
}

TEST(Layers, StandOnBothSidesOfAnInterfaceOrOnOne) {
  constexpr int n = 4, interface = 7;
  Lattice box = tagged_lattice(
      n, [](int, int, int) { return true; }, [](int i, int, int) { return i < 2 ? 1 : 2; });
  for (std::size_t t = 0; t < box.mesh.triangles.size(); ++t) {
    const bool inside = std::ranges::all_of(box.mesh.triangles[t], [&](Vertex v) { return box.mesh.points[v].x == 2; });
    if (inside) box.mesh.triangle_tags[t] = interface;
  }
  const AssembleResult both = with_layers(box, options_with({{"7", 2}}, 0.1));
  EXPECT_NEAR(expect_sound(both.mesh), n * n * n, 1e-9);
  EXPECT_EQ(both.mesh.hexes.size(), static_cast<std::size_t>(n * n * n + 4 * n * n));
  LayerOptions options = options_with({{"7 in water", 2}}, 0.1);
  options.tag_names.regions = {{2, "water"}};
  const AssembleResult one = with_layers(box, options);
  EXPECT_NEAR(expect_sound(one.mesh), n * n * n, 1e-9);
  EXPECT_EQ(one.mesh.hexes.size(), static_cast<std::size_t>(n * n * n + 2 * n * n));
  EXPECT_EQ(std::ranges::count(one.mesh.hexes.tags, 1), 2 * n * n);
}

// An interface stands on the wall: it goes on between the columns.
TEST(Layers, LetInterfacesReachTheWall) {
  constexpr int n = 4, layers = 3;
  const Lattice box = tagged_lattice(
      n, [](int, int, int) { return true; }, [](int i, int, int) { return i < 2 ? 1 : 2; });
  const AssembleResult result = with_layers(box, options_with({{"5", layers}}, 0.1));
  EXPECT_NEAR(expect_sound(result.mesh), n * n * n, 1e-9);
  EXPECT_EQ(result.mesh.quads.size(), static_cast<std::size_t>(7 * n * n + 5 * layers * n));
}

TEST(Layers, AreLowerInAThinPlate) {
  constexpr int n = 4;
  Lattice plate = tagged_lattice(n);
  for (Vec3& p : plate.mesh.points) p.z *= 0.05;
  for (double& volume : plate.cubes.volume) volume *= 0.05;
  // Ten times as high as the plate is thick.
  const AssembleResult result = with_layers(plate, options_with({{"5", 3}, {"6", 3}}, 0.5));
  EXPECT_NEAR(expect_sound(result.mesh), 0.05 * n * n * n, 1e-9);
  EXPECT_EQ(result.statistics.layers->area_with_layers, 2 * n * n);
  EXPECT_EQ(result.statistics.layers->area_with_all, 0);
  EXPECT_LT(result.statistics.layers->least_share, 0.1);
  EXPECT_GT(result.statistics.layers->least_share, 0.01);
}

// The lattice is bent to a quarter of a tube, with walls inside and outside: all levels of a line at the ends stay in
// the plane of the ends.
TEST(Layers, FollowATube) {
  constexpr int n = 6;
  Lattice tube = tagged_lattice(n);
  for (Vec3& p : tube.mesh.points) {
    const double angle = p.y / n * std::numbers::pi / 2, radius = n + p.x;
    p = {radius * std::cos(angle), radius * std::sin(angle), p.z};
  }
  const AssembleResult without = with_layers(tube, {});
  const AssembleResult result = with_layers(tube, options_with({{"1", 4}, {"2", 4}}, 0.05));
  EXPECT_NEAR(expect_sound(result.mesh), expect_sound(without.mesh), 1e-9 * n * n * n);
  EXPECT_NEAR(result.statistics.layers->area_with_all, result.statistics.layers->area, 1e-9);
  EXPECT_GT(result.statistics.layers->least_quality, 0.9);
}

// A box of which a part of the low side in k is a wall of its own.
constexpr std::int32_t part_of_side = 9;
Lattice box_with_wall(int n, const std::function<bool(const Vec3&)>& is_wall) {
  Lattice box = tagged_lattice(n);
  for (std::size_t t = 0; t < box.mesh.triangles.size(); ++t) {
    Vec3 middle{};
    for (const Vertex v : box.mesh.triangles[t]) middle += box.mesh.points[v] * (1.0 / 3);
    if (middle.z == 0 && is_wall(middle)) box.mesh.triangle_tags[t] = part_of_side;
  }
  return box;
}

double area_of_tag(const MixedMesh& mesh, std::int32_t tag) {
  double area = 0;
  const auto add = [&](const auto& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (block.tags[i] != tag) continue;
      const auto& facet = block.cells[i];
      for (std::size_t k = 2; k < facet.size(); ++k)
        area += norm(cross(mesh.points[facet[k - 1]] - mesh.points[facet[0]],
                           mesh.points[facet[k]] - mesh.points[facet[0]])) /
                2;
    }
  };
  add(mesh.triangles);
  add(mesh.quads);
  return area;
}

// Layers cannot end inside a plane at their full height. They run out over the first row of quads beyond the wall,
// which stay what they are.
TEST(Layers, RunOutBeyondAWallInAPlane) {
  constexpr int n = 6;
  const Lattice box = box_with_wall(n, [](const Vec3& at) { return at.x < 3; });
  const AssembleResult result = with_layers(box, options_with({{"9", 2}}, 0.1));
  EXPECT_NEAR(expect_sound(result.mesh), n * n * n, 1e-9);
  EXPECT_EQ(result.statistics.layers->area, 3 * n);
  EXPECT_EQ(result.statistics.layers->area_with_all, 3 * n);
  EXPECT_EQ(result.mesh.hexes.size(), static_cast<std::size_t>(n * n * n + 2 * 3 * n));
  EXPECT_EQ(result.mesh.prisms.size(), static_cast<std::size_t>(2 * n));
  EXPECT_NEAR(area_of_tag(result.mesh, part_of_side), 3 * n, 1e-9);
  EXPECT_NEAR(area_of_tag(result.mesh, low_k), 3 * n, 1e-9);
}

// Beyond the corner of such a wall a quad has one line with a length: it is cut, and the hex behind it is opened.
TEST(Layers, RunOutBeyondACornerInAPlane) {
  constexpr int n = 6;
  const Lattice box = box_with_wall(n, [](const Vec3& at) { return at.x < 3 && at.y < 3; });
  const AssembleResult result = with_layers(box, options_with({{"9", 2}}, 0.1));
  EXPECT_NEAR(expect_sound(result.mesh), n * n * n, 1e-9);
  EXPECT_EQ(result.statistics.layers->area, 9);
  EXPECT_EQ(result.statistics.layers->area_with_all, 9);
  EXPECT_EQ(result.mesh.pyramids.size(), 5u);
  EXPECT_EQ(result.mesh.tets.size(), 4u);  // two of the hex, and one in each layer
}

// Between two walls of one number of layers, a row of quads has layers from both sides; where the numbers differ, each
// wall's layers run out within it.
TEST(Layers, MeetOverARowBetweenTwoWalls) {
  constexpr int n = 6, other = 10;
  Lattice box = box_with_wall(n, [](const Vec3& at) { return at.x < 3; });
  for (std::size_t t = 0; t < box.mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = box.mesh.triangles[t];
    const Vec3 middle = (box.mesh.points[a] + box.mesh.points[b] + box.mesh.points[c]) * (1.0 / 3);
    if (middle.z == 0 && middle.x > 4) box.mesh.triangle_tags[t] = other;
  }
  const AssembleResult same = with_layers(box, options_with({{"9", 2}, {"10", 2}}, 0.1));
  EXPECT_NEAR(expect_sound(same.mesh), n * n * n, 1e-9);
  EXPECT_EQ(same.statistics.layers->area_with_all, 5 * n);
  EXPECT_EQ(same.mesh.prisms.size(), 0u);
  const AssembleResult different = with_layers(box, options_with({{"9", 2}, {"10", 3}}, 0.1));
  EXPECT_NEAR(expect_sound(different.mesh), n * n * n, 1e-9);
  EXPECT_EQ(different.statistics.layers->area_with_layers, 3 * n);
  EXPECT_EQ(different.statistics.layers->area_with_some, 5 * n);
}

// The wall ends at the inner edge of an L, where the part goes on to both sides: its layers run out on the other side
// of the edge.
TEST(Layers, RunOutBehindAnInnerEdge) {
  constexpr int n = 4;
  const Lattice l = tagged_lattice(n, [](int i, int j, int) { return i < 2 || j < 2; });
  const AssembleResult result = with_layers(l, options_with({{"2", 2}}, 0.1));
  EXPECT_NEAR(expect_sound(result.mesh), 48, 1e-9);
  EXPECT_EQ(result.statistics.layers->area, 16);
  EXPECT_EQ(result.statistics.layers->area_with_layers, 16);
}

TEST(Layers, SitOnMixedCells) {
  Random random(7);
  Lattice lattice = tagged_lattice(5);
  testing::jitter(lattice, 0.15, random);
  const AssembleResult result =
      assemble::assemble(lattice.mesh, lattice.cubes, testing::random_choice(lattice, 0.5, random), {}, {},
                         options_with({{"all", 4}}, 0.03));
  EXPECT_NEAR(expect_sound(result.mesh), 125, 1e-9);
  EXPECT_GT(result.mesh.prisms.size(), 0u);
  EXPECT_NEAR(result.statistics.layers->area_with_layers, 150, 1e-9);
}

TEST(Layers, APillowIsOneLayer) {
  constexpr int n = 4;
  LayerOptions options;
  options.pillow = true;
  const AssembleResult result = with_layers(tagged_lattice(n), options);
  EXPECT_NEAR(expect_sound(result.mesh), n * n * n, 1e-9);
  EXPECT_EQ(result.mesh.hexes.size(), static_cast<std::size_t>(n * n * n + 6 * n * n));
  ASSERT_TRUE(result.statistics.pillow);
  EXPECT_FALSE(result.statistics.layers);
}

// All layers of both walls have to stand in a plate of 4e-8: they would be lower than 1e-9 of its diagonal.
TEST(Layers, AreNotAtTheLimitOfCoordinates) {
  constexpr int n = 4;
  Lattice plate = tagged_lattice(n);
  for (Vec3& p : plate.mesh.points) p.z *= 1e-8;
  for (double& volume : plate.cubes.volume) volume *= 1e-8;
  const AssembleResult result = with_layers(plate, options_with({{"5", 3}, {"6", 3}}, 0.5));
  EXPECT_EQ(result.statistics.layers->cells, 0);
  EXPECT_EQ(result.mesh.hexes.size(), static_cast<std::size_t>(n * n * n));
  EXPECT_EQ(layers_warning(result.statistics), "there are no layers: no line could leave its wall");
  const auto json = to_json(result.statistics)["layers"];
  EXPECT_TRUE(json["least_share_of_height"].is_null());
  EXPECT_TRUE(json["scaled_jacobian"]["least"].is_null());
  EXPECT_THAT(summary_lines(result.statistics), ::testing::Contains("layers: 0 cells on 0.00 % of 32 of wall area"));
}

TEST(Layers, APillowThatIsMissingIsTold) {
  constexpr int n = 4;
  Lattice plate = tagged_lattice(n);
  for (Vec3& p : plate.mesh.points) p.z *= 1e-9;
  for (double& volume : plate.cubes.volume) volume *= 1e-9;
  LayerOptions options;
  options.pillow = true;
  EXPECT_EQ(pillow_warning(with_layers(plate, options).statistics),
            "the pillow is missing on 96 of 96 facets of the boundary: no line could leave them");
  EXPECT_FALSE(pillow_warning(with_layers(tagged_lattice(n), options).statistics));
}

// As check_layered() sees a right result that is damaged.
TEST(Layers, AreCheckedAgain) {
  const Lattice box = tagged_lattice(3);
  AssembleResult result = with_layers(box, options_with({{"5", 2}}, 0.1));
  const shape::InputSurface surface(box.mesh, TetAdjacency(box.mesh, "box"));
  const auto error = [&](double volume, double deviation) {
    return message_from([&] {
      check_layered(result.mesh, result.origin, box.mesh, surface, {{{1, volume}}, deviation});
    });
  };
  EXPECT_EQ(error(27, 0), "");
  EXPECT_THAT(error(27.1, 0), HasSubstr("expected a volume of 27.1 in region 1"));
  EXPECT_EQ(error(27.1, 0.001), "");
  result.origin[result.mesh.quads.cells.back()[0]] = static_cast<Vertex>(box.mesh.points.size());
  EXPECT_THAT(error(27, 0), HasSubstr("expected the input's vertices on the boundary"));
}

TEST(Layers, WallsWithoutAreaAreTold) {
  AssembleStatistics statistics;
  statistics.layers.emplace();
  EXPECT_EQ(layers_warning(statistics), "there are no layers: the walls have no area");
}

TEST(Layers, RefuseAHeightThatIsNothing) {
  EXPECT_THAT(message_from([] {
                with_layers(tagged_lattice(3), options_with({{"5", 3}}, 5e-9));
              }),
              HasSubstr("--first-height: expected at least 5.2e-09"));
  EXPECT_NO_THROW(with_layers(tagged_lattice(3), options_with({{"5", 3}}, 6e-9)));
}

TEST(LayerHeights, GrowByTheFactor) {
  EXPECT_DOUBLE_EQ(share_of_height(1, 4, 1), 0.25);
  EXPECT_DOUBLE_EQ(share_of_height(1, 2, 2), 1.0 / 3);
  EXPECT_DOUBLE_EQ(share_of_height(2, 3, 2), 3.0 / 7);
  EXPECT_DOUBLE_EQ(share_of_height(5, 5, 1.2), 1);
}

TEST(GuideFreedom, IsThatOfTheFacesBesideTheLine) {
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  EXPECT_EQ(freedom_of({}).kind, GuideFreedom::Kind::space);
  const std::array same{Guide{x, {}, 3}, Guide{-x, {}, 3}, Guide{unit({1, 0.2, 0}), {}, 3}};
  EXPECT_EQ(freedom_of(same).kind, GuideFreedom::Kind::face);
  const std::array two{Guide{x, {}, 3}, Guide{y, {}, 4}};
  EXPECT_EQ(freedom_of(two).kind, GuideFreedom::Kind::curve);
  EXPECT_EQ(std::abs(freedom_of(two).axis.z), 1);
  EXPECT_THAT(freedom_of(two).tags, ::testing::ElementsAre(3, 4));
  const std::array three{Guide{x, {}, 3}, Guide{y, {}, 4}, Guide{z, {}, 4}};
  EXPECT_EQ(freedom_of(three).kind, GuideFreedom::Kind::none);
}

std::string complaint_about(const std::string& walls) {
  try {
    const auto asked = parse_walls(walls);
    find_walls(asked, tagged_lattice(2).mesh, {{{5, "floor"}}, {{1, "water"}}}, "box");
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

TEST(WallChoice, FindsSurfacesByNameAndNumber) {
  const auto tags_of = [](const std::string& text) {
    std::vector<std::int32_t> tags;
    for (const WallGroup& wall : find_walls(parse_walls(text), tagged_lattice(2).mesh,
                                            {{{5, "floor"}, {6, "lid in red"}}, {{1, "water"}}}, "box"))
      tags.push_back(wall.tag);
    return tags;
  };
  EXPECT_THAT(tags_of("floor=3"), ::testing::ElementsAre(5));
  EXPECT_THAT(tags_of("surface_5=3, 6 =4"), ::testing::ElementsAre(5, 6));
  EXPECT_THAT(tags_of("lid in red=3"), ::testing::ElementsAre(6));
  EXPECT_THAT(tags_of("floor in water=3"), ::testing::ElementsAre(5));
  EXPECT_EQ(tags_of("all=3").size(), 6u);
}

// A box of two regions; surface 7 lies between them, at x = 1, and surface 1 at x = 0 bounds region 1 alone.
TetMesh box_of_two_regions() {
  return tagged_lattice(
             2, [](int, int, int) { return true; }, [](int i, int, int) { return i < 1 ? 1 : 2; })
      .mesh;
}

std::vector<WallGroup> walls_of_two_regions(const std::string& text, const TagNames& names) {
  TetMesh mesh = box_of_two_regions();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (std::ranges::all_of(mesh.triangles[t], [&](Vertex v) { return mesh.points[v].x == 1; }))
      mesh.triangle_tags[t] = 7;
  return find_walls(parse_walls(text), mesh, names, "box");
}

TEST(WallChoice, TakesOneSideOrBoth) {
  const TagNames names{{{7, "film"}}, {{1, "water"}, {2, "air"}}};
  const auto regions_of = [&](const std::string& text) { return walls_of_two_regions(text, names).at(0).regions; };
  EXPECT_THAT(regions_of("7=2"), ::testing::IsEmpty());
  EXPECT_THAT(regions_of("film in air=2"), ::testing::ElementsAre(2));
  EXPECT_THAT(regions_of("7 in 1=2, film in air=2"), ::testing::ElementsAre(1, 2));
  EXPECT_THAT(regions_of("7 in 1=2, 7=2"), ::testing::IsEmpty());
  // Interfaces bound a region, too; the side at x = 2 does not bound the one at x = 0.
  std::vector<std::int32_t> tags;
  for (const WallGroup& wall : walls_of_two_regions("all in water=1", names)) tags.push_back(wall.tag);
  EXPECT_THAT(tags, ::testing::ElementsAre(1, 3, 4, 5, 6, 7));
}

TEST(WallChoice, RefusesSurfacesThatDoNotBoundTheRegion) {
  const TagNames names{{{7, "film"}}, {{1, "water"}, {2, "air"}}};
  const auto message = [&](const std::string& text) {
    return message_from([&] { walls_of_two_regions(text, names); });
  };
  EXPECT_THAT(message("1 in air=2"), HasSubstr("expected surface '1' to bound region 'air'; it bounds 1 (water)"));
  EXPECT_THAT(message("film in water=2, 7 in air=3"),
              HasSubstr("expected as many layers on both sides of surface 7 (film), found 'film in water=2' and "
                        "'7 in air=3'; '7=2' puts layers on both"));
  EXPECT_THAT(message("film=2, 7=3"), HasSubstr("expected surface 7 (film) once, found it with 2 and with 3 layers"));
  EXPECT_THAT(message("film=2, 5=3"), HasSubstr("surface 7 (film)"));
}

TEST(WallChoice, TakesANameBeforeANumber) {
  const auto tags_of = [](const std::string& text, const TagNames& names) {
    std::vector<std::int32_t> tags;
    for (const WallGroup& wall : walls_of_two_regions(text, names)) tags.push_back(wall.tag);
    return tags;
  };
  EXPECT_THAT(tags_of("3=1", {{{1, "3"}}, {}}), ::testing::ElementsAre(1));
  EXPECT_THAT(tags_of("surface_3=1", {{{1, "3"}}, {}}), ::testing::ElementsAre(3));
  EXPECT_THAT(tags_of("sides=1", {{{1, "sides"}, {2, "sides"}}, {}}), ::testing::ElementsAre(1, 2));
  const TagNames regions{{}, {{1, "2"}}};
  EXPECT_THAT(walls_of_two_regions("7 in 2=1", regions).at(0).regions, ::testing::ElementsAre(1));
  const TagNames alike{{}, {{1, "fluid"}, {2, "fluid"}}};
  EXPECT_THAT(walls_of_two_regions("7 in fluid=1", alike).at(0).regions, ::testing::ElementsAre(1, 2));
}

TEST(WallChoice, ReadsNamesWithCommas) {
  const auto names_of = [](const std::string& text) {
    std::vector<std::string> names;
    for (const AskedWall& wall : parse_walls(text)) names.push_back(wall.name);
    return names;
  };
  EXPECT_THAT(names_of("wall, left=3, lid=2"), ::testing::ElementsAre("wall, left", "lid"));
  EXPECT_THAT(names_of("a=b, c = 3 ,d=1"), ::testing::ElementsAre("a=b, c", "d"));
}

TEST(WallChoice, SaysWhatIsWrong) {
  EXPECT_THAT(complaint_about("flor=3"),
              HasSubstr("found 'flor' (did you mean 'floor'?); there are 1, 2, 3, 4, 5 (floor), 6"));
  EXPECT_THAT(complaint_about("floor in wter=3"), HasSubstr("expected a region by its name or number, found 'wter'"));
  EXPECT_THAT(complaint_about("floor"), HasSubstr("as 'wall=5', found 'floor'"));
  EXPECT_THAT(complaint_about("=3"), HasSubstr("as 'wall=5', found '=3'"));
  EXPECT_THAT(complaint_about("floor=0"), HasSubstr("expected 1 to 100 layers on 'floor', found '0'"));
  EXPECT_THAT(complaint_about("floor=2.5"), HasSubstr("found '2.5'"));
  EXPECT_THAT(complaint_about("floor=3,1=4"), HasSubstr("as many layers on surfaces that touch"));
  EXPECT_THAT(complaint_about("floor=3,5=4"), HasSubstr("expected surface 5 (floor) once"));
  EXPECT_THAT(complaint_about("floor=3,"), HasSubstr("as 'wall=5', found ''"));
  EXPECT_THAT(complaint_about("floor=x,6=3"), HasSubstr("found 'floor=x,6'"));
  EXPECT_EQ(complaint_about("floor=3,6=4"), "");
}

}  // namespace
}  // namespace hexpipe
