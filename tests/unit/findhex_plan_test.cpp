#include "common/candidates/search_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include "common/run/random.hpp"

namespace hexpipe {
using namespace candidates;
namespace {

template <class Topology>
class Plan : public ::testing::Test {};
using AllTopologies = ::testing::Types<HexTopology, PrismTopology, PyramidTopology>;
TYPED_TEST_SUITE(Plan, AllTopologies);

template <class Topology>
bool maps_edges_to_edges(const Rotation<Topology>& rotation) {
  return std::ranges::all_of(Topology::edges, [&](const LocalEdge& e) {
    return std::ranges::any_of(Topology::edges, [&](const LocalEdge& f) {
      return std::minmax<int>(rotation[e[0]], rotation[e[1]]) == std::minmax<int>(f[0], f[1]);
    });
  });
}

TYPED_TEST(Plan, RotationsAreAGroupOfTheCell) {
  constexpr auto group = rotations_of<TypeParam>();
  std::set<Rotation<TypeParam>> all(group.begin(), group.end());
  EXPECT_EQ(all.size(), group.count);
  for (const auto& a : all) {
    EXPECT_TRUE(maps_edges_to_edges<TypeParam>(a));
    for (const auto& b : all) {
      Rotation<TypeParam> product{};
      for (int c = 0; c < TypeParam::corner_count; ++c) product[c] = a[b[c]];
      EXPECT_TRUE(all.count(product));
    }
  }
}

template <class Topology>
bool is_found(const std::vector<int>& vertex) {
  return std::ranges::all_of(search_plan<Topology>, [&](const SearchStep& step) {
    for (std::size_t i = 0; i < step.greater.size(); ++i)
      if (vertex[step.corner] <= vertex[step.greater[i]]) return false;
    return true;
  });
}

// However the vertices of a cell are numbered, one of its labellings is visited, and no other.
TYPED_TEST(Plan, VisitsOneLabellingOfEachCell) {
  Random random(1);
  std::vector<int> vertex(TypeParam::corner_count);
  std::iota(vertex.begin(), vertex.end(), 0);
  for (int n = 0; n < 500; ++n) {
    random.shuffle(std::span(vertex));
    int visited = 0;
    for (const auto& rotation : rotations_of<TypeParam>()) {
      std::vector<int> turned(vertex.size());
      for (std::size_t c = 0; c < vertex.size(); ++c) turned[c] = vertex[rotation[c]];
      visited += is_found<TypeParam>(turned);
    }
    EXPECT_EQ(visited, 1);
  }
}

TYPED_TEST(Plan, TestsEverythingOnce) {
  std::size_t edges = 0, opened = 0, quads = 0, triangles = 0, corners = 0;
  std::set<int> placed;
  for (const SearchStep& step : search_plan<TypeParam>) {
    edges += step.edges.size();
    opened += step.opened_quads.size();
    quads += step.closed_quads.size();
    triangles += step.triangles.size();
    corners += step.corners.size() + step.outer_corners.size();
    if (!placed.empty()) {
      EXPECT_TRUE(step.closed_quads.size() > 0 || step.is_beside_first);
    }
    placed.insert(step.corner);
  }
  EXPECT_EQ(placed.size(), std::size_t{TypeParam::corner_count});
  EXPECT_EQ(edges, TypeParam::edges.size());
  EXPECT_EQ(opened, TypeParam::quads.size());
  EXPECT_EQ(quads, TypeParam::quads.size());
  EXPECT_EQ(triangles, TypeParam::triangles.size());
  EXPECT_EQ(corners, TypeParam::corners.size());
}

}  // namespace
}  // namespace hexpipe
