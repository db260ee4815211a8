// The scene of viewmesh: cells, facets, layers, and the state that chooses among them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/run/error.hpp"
#include "tests/unit/viewmesh_lattice.hpp"
#include "tools/viewmesh/facets.hpp"
#include "tools/viewmesh/scene.hpp"
#include "tools/viewmesh/skin.hpp"
#include "tools/viewmesh/view_state.hpp"
#include "tools/viewmesh/visible_cells.hpp"

namespace hexpipe {
using namespace pipeline;
using namespace viewmesh;
namespace {

std::ptrdiff_t visible_count(const Scene& scene, const ViewState& state) {
  const auto visible = visible_cells(scene, state);
  return std::count(visible.begin(), visible.end(), true);
}

TEST(Scene, HoldsTheCellsInABallOfRadiusOne) {
  const Scene scene = lattice_scene(3);
  EXPECT_EQ(scene.cell_count(), 27);
  EXPECT_EQ(scene.kind_of(26), CellKind::hex);
  EXPECT_FLOAT_EQ(scene.quality[0], 1);
  double farthest = 0;
  for (std::size_t i = 0; i < scene.points.size(); ++i)
    farthest = std::max(farthest, norm(scene.point(static_cast<int>(i))));
  EXPECT_NEAR(farthest, 1, 1e-6);
  EXPECT_EQ(scene.centre, (Vec3{1.5, 1.5, 1.5}));
}

TEST(Scene, LeavesPointsOutOfTheBoxThatNoCellUses) {
  StageData data = hex_lattice(2);
  data.result->points.push_back({100, 100, 100});
  EXPECT_EQ(make_scene(data, Scene::Content::result, "test").centre, (Vec3{1, 1, 1}));
}

TEST(Scene, CountsLayersFromTheSurface) {
  const Scene scene = lattice_scene(5);
  std::array<int, 4> cells{};
  for (const auto layer : scene.layer) ++cells.at(layer);
  EXPECT_EQ(cells, (std::array{0, 98, 26, 1}));
}

TEST(Scene, KindsFollowEachOther) {
  MixedMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}};
  mesh.pyramids.cells = {{0, 1, 2, 3, 4}};
  mesh.tets.cells = {{0, 2, 1, 5}, {0, 3, 2, 5}};
  mesh.pyramids.tags = {1};
  mesh.tets.tags = {2, 2};
  StageData data;
  data.result = mesh;
  const Scene scene = make_scene(data, Scene::Content::result, "test");
  EXPECT_EQ(scene.kind_begin, (std::array{0, 0, 0, 1, 3}));
  EXPECT_EQ(scene.kind_of(0), CellKind::pyramid);
  EXPECT_EQ(scene.kind_of(1), CellKind::tet);
  EXPECT_THAT(scene.corners_of(2), ::testing::ElementsAre(0, 3, 2, 5));
  EXPECT_THAT(scene.region, ::testing::ElementsAre(1, 2, 2));
}

TEST(Scene, SaysWhatIsMissing) {
  EXPECT_THROW(last_content(StageData{}, "test"), DataError);
  EXPECT_THROW(make_scene(StageData{}, Scene::Content::candidates, "test"), DataError);
  StageData empty;
  empty.result.emplace();
  EXPECT_THROW(make_scene(empty, Scene::Content::result, "test"), DataError);
}

TEST(Skin, IsTheSurfaceOfWhatIsVisible) {
  const Scene scene = lattice_scene(4);
  ViewState state;
  EXPECT_EQ(visible_skin(scene, state).size(), 6 * 16 * 2 * 3);
  state.peel = 1;
  EXPECT_EQ(visible_skin(scene, state).size(), 6 * 4 * 2 * 3);
  state.peel = 0;
  state.clip = {{1, 0, 0}, 0.5};
  EXPECT_EQ(visible_skin(scene, state).size(), (2 * 16 + 4 * 8) * 2 * 3);
  state.kinds[0] = false;
  EXPECT_TRUE(visible_skin(scene, state).empty());
}

TEST(Skin, NormalsPointOut) {
  const Scene scene = lattice_scene(2);
  for (const SkinVertex& vertex : visible_skin(scene, {})) {
    double out = 0;
    for (int axis = 0; axis < 3; ++axis) out += vertex.position[axis] * vertex.normal[axis];
    EXPECT_GT(out, 0);
  }
}

TEST(Skin, OfCellsThatOverlapShowsFacetsWithCellsOnOneSide) {
  StageData data = hex_lattice(1);
  data.result->hexes.cells.push_back(data.result->hexes.cells.front());
  data.result->hexes.tags.push_back(0);
  const Scene scene = make_scene(data, Scene::Content::result, "test");
  EXPECT_EQ(visible_skin(scene, {}).size(), 6 * 2 * 3);
}

TEST(ViewState, ClipsWholeCellsByTheirMiddles) {
  const Scene scene = lattice_scene(4);
  ViewState state;
  state.clip = {{0, 0, 1}, 0.6};
  EXPECT_EQ(visible_count(scene, state), 32);
  state.clip = {{0, 0, -1}, 0.3};
  EXPECT_EQ(visible_count(scene, state), 16);
}

TEST(ViewState, FiltersByQuality) {
  const Scene scene = lattice_scene(2);
  ViewState state;
  state.greatest_quality = 0.9;
  EXPECT_EQ(visible_count(scene, state), 0);
}

TEST(ViewState, TextAndBack) {
  const char* const opening =
      "clip=none&quality=-1,1&peel=0&kinds=hex,prism,pyramid,tet&hidden=none&colour=hexes&edges=on";
  for (const std::string& text :
       {fmt::format("camera=-52,28&up=z&{}&axes=on&legend=on&dislocations=off&theme=light&fragment=0", opening),
        fmt::format("camera=0,0,1,0,0,0&up=-y&{}&axes=off&legend=off&dislocations=on&theme=light&fragment=0", opening),
        std::string("camera=12.5,-90,3,0.1,-0.2,0.3&up=x&clip=-y:0.25&quality=0.1,0.75&peel=3&kinds=none&"
                    "hidden=region:3,surface:-7&colour=surface&edges=off&axes=on&legend=on&dislocations=off&theme=dark&"
                    "fragment=7")})
    EXPECT_EQ(to_text(parse_view_state(text)), text);
  EXPECT_EQ(to_text(ViewState{}), to_text(parse_view_state("camera=-52,28")));
}

TEST(ViewState, RefusesWhatIsNone) {
  for (const char* text : {"clip=a:1",
                           "clip=x:nan",
                           "quality=0",
                           "quality=2,3",
                           "peel=x",
                           "colour=",
                           "=",
                           "kinds=",
                           "kinds=hexes",
                           "kinds=hex,",
                           "quality=0,1,",
                           "peel=1&",
                           "camera=1,1,0,0,0,0",
                           "edges=1",
                           "theme",
                           "fragment=-1",
                           "clip=1,2,3:0.5",
                           "camera=1",
                           "camera=1,91",
                           "camera=1,2,3",
                           "up=w",
                           "up=",
                           "up=zz",
                           "axes=yes",
                           "legend=",
                           "dislocations=1"})
    EXPECT_THROW(parse_view_state(text), UsageError) << text;
}

}  // namespace
}  // namespace hexpipe
