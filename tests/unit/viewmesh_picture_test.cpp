// What viewmesh writes over its pictures.

#include <gtest/gtest.h>

#include "tests/unit/viewmesh_lattice.hpp"
#include "tools/viewmesh/picture/axis_marks.hpp"
#include "tools/viewmesh/picture/legend.hpp"
#include "tools/viewmesh/picture/legend_card.hpp"
#include "tools/viewmesh/picture/text.hpp"

namespace hexpipe {
using namespace viewmesh;
using namespace viewmesh::picture;
namespace {

constexpr Rgb black{0, 0, 0};

Picture white_picture(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(std::size_t{3} * width * height, 255)};
}

// How much of the picture is black, in pixels.
double blackness(const Picture& picture) {
  double sum = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) sum += 1 - picture.rgb[i] / 255.0;
  return sum;
}

TEST(Legend, TellsTheShareOfHexesAndWhatTheColoursMean) {
  const Scene scene = lattice_scene(3);
  ViewState state;
  Legend legend = legend_of(scene, state, "cube.vtu");
  EXPECT_EQ(legend.title, "cube.vtu");
  EXPECT_EQ(legend.share, "100.0 %");
  EXPECT_EQ(legend.ticks.size(), 5);
  EXPECT_TRUE(legend.keys.empty());  // there are no other cells
  state.colour = ViewState::Colour::orthogonality;
  EXPECT_EQ(legend_of(scene, state, "").ticks.front(), "70");
}

TEST(Legend, NamesTheGroupsThatAreShown) {
  const Scene scene = lattice_scene(3);
  ViewState state;
  state.colour = ViewState::Colour::region;
  ASSERT_EQ(legend_of(scene, state, "").keys.size(), 3);
  EXPECT_EQ(legend_of(scene, state, "").keys[1].text, "region_1");
  state.hidden = {{ViewState::HiddenGroup::Kind::region, 1, ""}};
  ASSERT_EQ(legend_of(scene, state, "").keys.size(), 2);
  EXPECT_EQ(legend_of(scene, state, "").keys[1].text, "region_2");
}

TEST(Legend, NamesDislocationsWhereTheyAreDrawn) {
  pipeline::StageData data = hex_lattice(2);
  data.dislocations = {{1, 1, 0, 1, 1, 2}};
  const Scene scene = make_scene(data, Scene::Content::result, "test");
  ViewState state;
  EXPECT_TRUE(legend_of(scene, state, "").keys.empty());
  state.dislocations = true;
  EXPECT_EQ(legend_of(scene, state, "").keys.back().text, "dislocations");
}

TEST(LegendCard, LeavesTheLargerPartOfThePictureFree) {
  Legend legend{
      .title = "a long title that has to be cut somewhere", .share = {}, .subject = "region", .ticks = {}, .keys = {}};
  for (int i = 0; i < 200; ++i) legend.keys.push_back({black, "group"});
  const LegendCard wide(legend, 12, 800, 500);
  EXPECT_GT(wide.free_frame().right, 0.2);
  EXPECT_EQ(wide.free_frame().top, 1);
  const LegendCard upright({.title = "t", .share = {}, .subject = "s", .ticks = {}, .keys = {}}, 12, 500, 800);
  EXPECT_GT(upright.free_frame().top, 0.6);
  EXPECT_EQ(upright.free_frame().right, 1);
  Picture picture = white_picture(800, 500);
  wide.draw(picture, true);
  EXPECT_GT(blackness(picture), 1000);
}

TEST(Font, DrawsAsWideAsItSays) {
  const Font font(20);
  EXPECT_GT(font.width("ww"), font.width("ii"));
  EXPECT_GT(font.width("hexes", Weight::bold), font.width("hexes"));
  // Two bytes of UTF-8 are one letter; what is no UTF-8 is a letter, too.
  EXPECT_LT(font.width("\u00e9"), font.width("ee"));
  EXPECT_GT(font.width("\xff"), 0);
  Picture picture = white_picture(200, 40);
  font.draw(picture, {10, 30}, "hexes", black);
  const double drawn = blackness(picture);
  EXPECT_GT(drawn, 100);
  const int right = 11 + static_cast<int>(font.width("hexes"));
  for (int y = 0; y < 40; ++y) EXPECT_EQ(picture.rgb[3 * (y * 200 + right + 1)], 255);
}

TEST(Font, CutsWhatHasNoRoom) {
  const Font font(12);
  EXPECT_EQ(font.cut_to("inlet", 1000), "inlet");
  const std::string cut = font.cut_to("a name of many letters, \u00e9\u00e9\u00e9\u00e9", 60);
  EXPECT_TRUE(cut.ends_with("…"));
  EXPECT_LE(font.width(cut), 60);
}

TEST(Canvas, CoversPixelsByTheirParts) {
  Picture picture = white_picture(30, 30);
  fill_box(picture, {5, 5, 15, 10}, 0, black);
  EXPECT_NEAR(blackness(picture), 50, 0.5);
  Picture line = white_picture(30, 30);
  draw_line(line, {5, 15}, {25, 15}, 2, black);
  EXPECT_NEAR(blackness(line), 2 * 20 + 3.14, 1.5);
  // What lies outside is left out.
  draw_line(line, {-50, -50}, {80, 80}, 3, black);
}

TEST(AxisMarks, TakeRoundLengths) {
  EXPECT_DOUBLE_EQ(round_length(1), 1);
  EXPECT_DOUBLE_EQ(round_length(4.9), 2);
  EXPECT_DOUBLE_EQ(round_length(73), 50);
  EXPECT_DOUBLE_EQ(round_length(0.0031), 0.002);
}

TEST(AxisMarks, AreDrawnInTheLowerLeftCorner) {
  Picture picture = white_picture(600, 400);
  draw_axis_marks(picture, camera_of({}, 1.5), 3, 12, false);
  EXPECT_GT(blackness(picture), 50);
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 600; ++x) ASSERT_EQ(picture.rgb[3 * (y * 600 + x)], 255);
}

}  // namespace
}  // namespace hexpipe
