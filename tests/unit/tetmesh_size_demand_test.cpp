#include "tools/tetmesh/sizing/size_demand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "common/run/error.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/asked_sizes.hpp"

namespace hexpipe {
using namespace tetmesh;
using namespace tetmesh::sizing;
using namespace tetmesh::solid;
namespace {

using testing::cube;
using testing::sphere;
using testing::surface_of;
using testing::tag_where;

constexpr double feature_angle = 40;

TEST(SizeDemand, HasTheGreatestSizeOfTheRequestOrOfItsPlacesOrOneThatSuitsTheModel) {
  const Surface surface = surface_of(cube());
  SizeRequest request;
  EXPECT_DOUBLE_EQ(demand_on(surface, request, feature_angle, false).greatest, element_size(surface, {}, false));
  request.sources = {{{0, 0, 0}}, {0.25}, {{0, no_index, no_index, no_index}}, {}};
  EXPECT_DOUBLE_EQ(demand_on(surface, request, feature_angle, false).greatest, 0.25);
  request.size = Length{0.5, false};
  EXPECT_DOUBLE_EQ(demand_on(surface, request, feature_angle, false).greatest, 0.5);
}

TEST(SizeDemand, TakesTheSizesOfNamedSurfaces) {
  Surface surface = surface_of(cube(0, 4, 4));
  tag_where(surface, 7, [](const Vec3& p) { return p.z < 1e-9; });
  surface.names.surfaces[7] = "floor";
  const auto demand_with = [&](const std::string& text) {
    const std::array asked{parse_asked_size(text)};
    SizeDemand demand = demand_on(surface, {.size = Length{1, false}, .grading = 0.2}, feature_angle, false);
    add_asked_sizes(surface, asked, 60, demand);
    return demand;
  };
  for (const std::string text : {"floor=0.1", "7=0.1", "surface_7=0.1"}) {
    const SizeField size = field_of(surface, demand_with(text));
    EXPECT_NEAR(size.at({1.3, 2.2, 0}), 0.1, 1e-9) << text;
    EXPECT_NEAR(size.at({1.3, 2.2, 1}), 0.3, 1e-9) << text;
  }
  EXPECT_THROW(demand_with("roof=0.1"), DataError);
}

TEST(SizeDemand, HasAnNthOfATurnWhereTheSurfaceBendsButNoLessThanTheLeastSize) {
  const Surface surface = surface_of(sphere({0, 0, 0}, 2, 24));
  const auto sizes_with = [&](std::optional<Length> least) {
    return demand_on(surface, {.size = Length{1, false}, .curvature = 30, .least = least}, feature_angle, false)
        .sources.sizes;
  };
  const double expected = 2 * std::numbers::pi * 2 / 30;
  const auto sizes = sizes_with({});
  ASSERT_FALSE(sizes.empty());
  EXPECT_LT(std::ranges::min(sizes), expected);
  EXPECT_GT(std::ranges::max(sizes), 0.9 * expected);
  EXPECT_GE(std::ranges::min(sizes), 0.2);
  EXPECT_DOUBLE_EQ(std::ranges::min(sizes_with(Length{0.6, false})), 0.6);
}

TEST(SizeDemand, IsScaledAsAWhole) {
  const Surface surface = surface_of(cube(0, 4, 4));
  const SizeRequest request{.size = Length{1, false},
                            .sources = {{{0, 0, 0}}, {0.1}, {{0, no_index, no_index, no_index}}, {}}};
  const SizeDemand demand = demand_on(surface, request, feature_angle, false), half = 0.5 * demand;
  EXPECT_DOUBLE_EQ(half.greatest, 0.5);
  EXPECT_EQ(half.sources.sizes.size(), demand.sources.sizes.size());
  EXPECT_DOUBLE_EQ(std::ranges::max(half.sources.sizes), 0.05);
}

}  // namespace
}  // namespace hexpipe
