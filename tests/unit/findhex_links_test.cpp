#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "common/candidates/quads.hpp"
#include "common/candidates/vertex_links.hpp"
#include "common/mesh/cell_topology.hpp"
#include "common/mesh/quality.hpp"
#include "findhex_meshes.hpp"

namespace hexpipe {
using namespace candidates;
namespace {

using testing::kuhn_lattice;
using testing::mesh_of;

// Tets around the edge 01: these two vertices have count + 1 neighbours.
TetMesh spindle(int count) {
  std::vector<Vec3> points{{0, 0, -1}, {0, 0, 1}};
  std::vector<Tet> tets;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    points.push_back({std::cos(angle), std::sin(angle), 0});
    tets.push_back({0, 1, 2 + i, 2 + (i + 1) % count});
  }
  return mesh_of(points, tets);
}

std::set<Triangle> facets_of(const TetMesh& mesh, const std::vector<bool>& usable) {
  std::set<Triangle> facets;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const LocalTriangle& c : TetTopology::triangles) {
      Triangle facet{mesh.tets[t][c[0]], mesh.tets[t][c[1]], mesh.tets[t][c[2]]};
      std::sort(facet.begin(), facet.end());
      if (usable[t]) facets.insert(facet);
    }
  return facets;
}

std::vector<bool> all_but_two(std::size_t count) {
  std::vector<bool> usable(count, true);
  usable[3] = usable[4] = false;
  return usable;
}

class Links : public ::testing::TestWithParam<int> {
 protected:
  Links()
      : mesh(GetParam() < 8 ? kuhn_lattice(GetParam()) : spindle(GetParam())),
        adjacency(mesh, "mesh"),
        usable(all_but_two(mesh.tets.size())),
        facets(facets_of(mesh, usable)),
        links(mesh, adjacency, usable) {}
  bool linked(Vertex a, Vertex b, Vertex c) const {
    Triangle facet{a, b, c};
    std::sort(facet.begin(), facet.end());
    return facets.contains(facet);
  }

  const TetMesh mesh;
  const TetAdjacency adjacency;
  const std::vector<bool> usable;
  const std::set<Triangle> facets;
  const VertexLinks links;
};

TEST_P(Links, AreTheFacetsOfUsableTets) {
  for (Vertex v = 0; v < static_cast<Vertex>(mesh.points.size()); ++v) {
    const auto neighbours = links.neighbours_of(v);
    for (int i = 0; i < static_cast<int>(neighbours.size()); ++i) {
      EXPECT_EQ(links.place_of(neighbours[i], v), i);
      std::vector<int> expected, found;
      for (int j = 0; j < static_cast<int>(neighbours.size()); ++j) {
        const bool is_facet = i != j && linked(v, neighbours[i], neighbours[j]);
        ASSERT_EQ(links.are_linked(v, i, j), is_facet) << v << ' ' << i << ' ' << j;
        EXPECT_EQ(i != j && links.is_facet(v, neighbours[i], neighbours[j]), is_facet);
        if (is_facet) expected.push_back(j);
      }
      links.for_each_linked(v, i, [&](int place) { found.push_back(place); });
      EXPECT_EQ(found, expected);
      EXPECT_EQ(links.link_count_exceeds_one(v, i), expected.size() > 1);
    }
    EXPECT_EQ(links.place_of(v, v), no_index);
  }
}

TEST_P(Links, OfTwoAndWithinTwo) {
  for (Vertex v = 0; v < std::min<Vertex>(40, static_cast<Vertex>(mesh.points.size())); ++v) {
    const int count = static_cast<int>(links.neighbours_of(v).size());
    const int first = count / 3;
    for (int i = 0; i < count; ++i) {
      std::set<int> within;
      for (int j = 0; j < count; ++j) {
        std::vector<int> expected, found;
        for (int k = 0; k < count; ++k)
          if (links.are_linked(v, i, k) && links.are_linked(v, j, k)) expected.push_back(k);
        links.for_each_linked_to_both(v, i, j, [&](int place) { found.push_back(place); });
        ASSERT_EQ(found, expected);
        EXPECT_EQ(links.have_common_link(v, i, j), !expected.empty());
        const bool through = std::ranges::any_of(expected, [&](int k) { return k >= first; });
        if (j > i && (links.are_linked(v, i, j) || through)) within.insert(j);
      }
      std::vector<int> found;
      links.for_each_within_two_links(v, i, first, [&](int place) { found.push_back(place); });
      EXPECT_EQ(found, std::vector<int>(within.begin(), within.end())) << v << ' ' << i;
    }
  }
}

// Four vertices are a quad where both triangles at one of its diagonals are facets.
TEST_P(Links, OppositesAreThoseOfAllVertices) {
  const auto vertices = std::min<Vertex>(30, static_cast<Vertex>(mesh.points.size()));
  for (Vertex v = 0; v < vertices; ++v) {
    const auto neighbours = links.neighbours_of(v);
    for (int i = 0; i < static_cast<int>(neighbours.size()); ++i)
      for (int j = i + 1; j < static_cast<int>(std::min<std::size_t>(neighbours.size(), i + 9)); ++j) {
        const Vertex a = neighbours[i], b = neighbours[j];
        std::vector<Vertex> expected;
        std::vector<OppositeCorner> memory;
        for (Vertex w = 0; w < static_cast<Vertex>(mesh.points.size()); ++w)
          if (w != v && w != a && w != b &&
              ((linked(v, a, w) && linked(v, b, w)) || (linked(a, b, v) && linked(a, b, w))))
            expected.push_back(w);
        const QuadAngle angle(links, v, i, j);
        const auto found = angle.find_opposites(links, memory);
        ASSERT_EQ(found.size(), expected.size()) << v << ' ' << a << ' ' << b;
        for (std::size_t k = 0; k < found.size(); ++k) {
          const auto [w, diagonals] = found[k];
          ASSERT_EQ(w, expected[k]) << v << ' ' << a << ' ' << b;
          EXPECT_EQ((diagonals & from_corner) != 0, linked(v, a, w) && linked(v, b, w));
          EXPECT_EQ((diagonals & between_sides) != 0, linked(a, b, v) && linked(a, b, w));
        }
        EXPECT_EQ(angle.has_opposite(links), !expected.empty());
        for (Vertex w = 0; w < static_cast<Vertex>(mesh.points.size()); ++w)
          if (w != v && w != a && w != b) {
            EXPECT_EQ(angle.has_opposite(links, w), std::ranges::binary_search(expected, w));
          }
      }
  }
}

// The look aheads of a fan may let too much through, but lose nothing.
TEST_P(Links, FansKnowWhichCornersSuffice) {
  constexpr double min_quality = 0.1;
  QuadFan fan(mesh, links, {min_quality, false});
  fan.find(0);
  const auto neighbours = links.neighbours_of(0);
  const auto from = [&](int place, Vertex end) { return mesh.points[end] - mesh.points[neighbours[place]]; };
  std::size_t quads = 0, sufficient = 0;
  const int end = std::min(static_cast<int>(neighbours.size()), fan.first_place() + 70);
  for (int place = fan.first_place(); place < end; ++place)
    for (int partner = fan.first_place(); partner < end; ++partner)
      for (int other = fan.first_place(); other < end; ++other) {
        if (fan.find_pair(place, partner) == nullptr || fan.find_pair(place, other) == nullptr) continue;
        const auto &pair = *fan.find_pair(place, partner), &other_pair = *fan.find_pair(place, other);
        EXPECT_EQ(&pair, fan.find_pair(partner, place));
        const std::size_t side = pair.places[0] == place ? 0 : 1, other_side = other_pair.places[0] == place ? 0 : 1;
        for (const auto& quad : fan.quads_of(pair))
          for (const auto& other_quad : fan.quads_of(other_pair)) {
            const std::int32_t edge = quad.outer_edges[side], next = other_quad.outer_edges[other_side];
            EXPECT_EQ(links.place_of(quad.opposite, neighbours[place]), fan.place_at_near_end(edge));
            const bool suffices = quad.opposite != other_quad.opposite &&
                                  scaled_jacobian_exceeds(from(place, 0), from(place, quad.opposite),
                                                          from(place, other_quad.opposite), min_quality);
            ASSERT_EQ(fan.corner_suffices(edge, next), suffices);
            if (suffices) {
              EXPECT_TRUE(fan.may_suffice_before(edge, other_pair, other_side));
              EXPECT_TRUE(fan.may_suffice_after(next, pair, side));
            }
            ++quads;
            sufficient += suffices ? 1 : 0;
          }
      }
  EXPECT_GT(quads, sufficient);
  EXPECT_GT(sufficient, 0u);
}

TEST_P(Links, FansKnowTheCornersAtTheirVertex) {
  constexpr double min_quality = 0.1;
  QuadFan fan(mesh, links, {min_quality, false});
  fan.find(0);
  const auto neighbours = links.neighbours_of(0);
  const auto to = [&](int place) { return mesh.points[neighbours[place]] - mesh.points[0]; };
  const auto bit = [&](auto&& bits, int place) {
    const int spoke = place - fan.first_place();
    return (bits(static_cast<std::size_t>(spoke) / 64) >> spoke % 64 & 1) != 0;
  };
  std::size_t sufficient = 0;
  for (int a = fan.first_place(); a < static_cast<int>(neighbours.size()); ++a)
    for (int b = fan.first_place(); b < static_cast<int>(neighbours.size()); ++b) {
      const auto partners = [&](std::size_t word) { return fan.partners_of(a, word); };
      ASSERT_EQ(bit(partners, b), fan.find_pair(a, b) != nullptr);
      ASSERT_EQ(bit([&](std::size_t word) { return fan.greater_than(a, word); }, b), b > a);
      const auto thirds = [&](std::size_t word) { return fan.third_edges(a, b, word); };
      for (int c = fan.first_place(); c < static_cast<int>(neighbours.size()); c += 3) {
        const bool suffices = scaled_jacobian_exceeds(to(a), to(b), to(c), min_quality);
        ASSERT_EQ(bit(thirds, c), suffices);
        sufficient += suffices ? 1 : 0;
      }
    }
  EXPECT_GT(sufficient, 0u);
}

// Lattices of n cubes along each side; spindles with that many tets. 63 leaves 64 neighbours, 64 one more.
INSTANTIATE_TEST_SUITE_P(Meshes, Links, ::testing::Values(2, 3, 20, 63, 64, 130));

}  // namespace
}  // namespace hexpipe
