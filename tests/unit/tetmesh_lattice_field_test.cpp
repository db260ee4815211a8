#include "tools/tetmesh/volume/lattice_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/unit/tetmesh_blocks.hpp"

namespace hexpipe {
using namespace tetmesh::volume;
namespace {

constexpr Vec3 up{0, 0, 1}, down{0, 0, -1}, along{1, 0, 0};
const Vec3 leaning = unit({0.6, 0, -0.8});  // 37 degrees out of down

TEST(StepsOnSurface, AreThoseAcrossThePartBetweenSidesThatFaceEachOther) {
  EXPECT_EQ(steps_on_surface(up, up, down, 0.8), 1);
  EXPECT_EQ(steps_on_surface(up, up, down, 1.4), 1);
  EXPECT_EQ(steps_on_surface(down, up, down, 1.5), 2);
  EXPECT_EQ(steps_on_surface(up, up, down, 1.75), 2);
  EXPECT_EQ(steps_on_surface(up, up, down, 1.8), std::nullopt);
}

TEST(StepsOnSurface, AreOneAtMostAlongIt) {
  EXPECT_EQ(steps_on_surface(along, up, up, 1.5), 1);
  EXPECT_EQ(steps_on_surface(along, up, down, 1.5), 1) << "the axis does not lead through the part";
  EXPECT_EQ(steps_on_surface(up, up, leaning, 1.5), 1) << "the sides do not face each other";
  EXPECT_EQ(steps_on_surface(along, up, up, 1.72), std::nullopt);
}

TEST(StepsOnSurface, AreNoneInOnePlaneAndNotKnownBetweenNoneAndOne) {
  for (const Vec3& other : {up, down}) {
    EXPECT_EQ(steps_on_surface(up, up, other, 0.2), 0);
    EXPECT_EQ(steps_on_surface(up, up, other, 0.5), std::nullopt);
  }
}

constexpr std::int32_t length = 6, height = 3;  // of a bar of cubes

struct Bar {
  TetMesh mesh;
  FieldNodes nodes;
  std::vector<tetmesh::fields::Frame> frames;

  // Sizes grow evenly from one end to the other.
  Bar(double first_size, double last_size) {
    std::vector<testing::Place> places = testing::places_up_to({length, height, height});
    std::ranges::stable_partition(places, [](const testing::Place& at) { return !is_inside(at); });
    std::map<testing::Place, Vertex> number;
    for (const testing::Place& at : places) {
      number[at] = static_cast<Vertex>(mesh.points.size());
      mesh.points.push_back({static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
    }
    testing::fill_with_cubes(
        {length, height, height}, [&](const testing::Place& at) { return number.at(at); }, mesh);
    const TetAdjacency adjacency(mesh, "bar");
    add_missing_boundary_triangles(mesh, adjacency, 0);
    nodes = testing::nodes_on(mesh, adjacency);
    nodes.triangles = mesh.triangles;
    for (std::size_t i = 0; i < places.size(); ++i) {
      nodes.sizes[i] = first_size + (last_size - first_size) * places[i][0] / length;
      if (!is_inside(places[i])) nodes.surface.push_back(node_at(places[i]));
    }
    frames.assign(mesh.points.size(), {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  }
  Bar(const Bar&) = delete;

  // Steps of the lattice from the bottom to the top.
  double rows_above(const LatticeField& field, double x, double y) const {
    double rows = 0;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.points.size()); ++i)
      for (const LatticeLink& link : field.links.of(static_cast<std::size_t>(i))) {
        const Vec3 &p = mesh.points[i], way = mesh.points[link.neighbour] - p;
        if (p.x == x && p.y == y && way.x == 0 && way.y == 0 && way.z == 1) rows += std::abs(link.distance[2]);
      }
    return rows;
  }

 private:
  static bool is_inside(const testing::Place& at) {
    return at[0] > 0 && at[0] < length && at[1] > 0 && at[1] < height && at[2] > 0 && at[2] < height;
  }
  static SurfaceNode node_at(const testing::Place& at) {
    const auto outwards = [](std::int32_t i, std::int32_t last) { return i == 0 ? -1.0 : i == last ? 1.0 : 0.0; };
    SurfaceNode node;
    node.normal = {outwards(at[0], length), outwards(at[1], height), outwards(at[2], height)};
    if (norm_squared(node.normal) > 1) node.kind = SurfaceNode::Kind::fixed;
    node.normal = unit(node.normal);
    return node;
  }
};

// By the sizes alone, rows would slope: three of them at one end, and 2.4 at the other.
TEST(LatticeField, HasLayersAlongFaces) {
  const Bar bar(1, 1.25);
  const LatticeField field = solve_lattice_field(bar.nodes, bar.frames, std::vector<bool>(bar.nodes.surface.size()));
  for (const Triangle& triangle : bar.mesh.triangles)
    for (std::size_t side = 0; side < 3; ++side) {
      const std::int32_t i = triangle[side], j = triangle[(side + 1) % 3];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<int>(k);
        if (std::ranges::any_of(
                triangle, [&](Vertex v) { return bar.mesh.points[v][axis] != bar.mesh.points[triangle[0]][axis]; }))
          continue;
        EXPECT_NEAR(field.links[field.links.between(i, j)].distance[k], 0, 0.03) << i << ", " << j;
      }
    }
  EXPECT_NEAR(bar.rows_above(field, 0, 1), bar.rows_above(field, length, 1), 0.25);
}

// By its size, the bar is 3.45 rows high. No point of its faces is held, only that each face is a layer.
TEST(LatticeField, HasWholeNumbersOfRowsBetweenFaces) {
  const Bar bar(height / 3.45, height / 3.45);
  const LatticeField field = solve_lattice_field(bar.nodes, bar.frames, std::vector<bool>(bar.nodes.surface.size()));
  for (int x = 0; x <= length; ++x)
    for (int y = 0; y <= height; ++y) EXPECT_NEAR(bar.rows_above(field, x, y), 3, 0.01) << x << ", " << y;
}

// Frames that turn by a right angle around an upright line in a block. The axes along the line lean, so that a walk
// around the line leads up by 0.4 of a layer.
TEST(LatticeField, HasLayersThatMeetAroundSingularities) {
  constexpr std::int32_t width = 6, layers = 3;
  constexpr double pitch = 0.4, centre_x = 3.3, centre_y = 2.7;
  TetMesh mesh;
  std::map<testing::Place, Vertex> number;
  for (const testing::Place& at : testing::places_up_to({width, width, layers})) {
    number[at] = static_cast<Vertex>(mesh.points.size());
    mesh.points.push_back({static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
  }
  testing::fill_with_cubes(
      {width, width, layers}, [&](const testing::Place& at) { return number.at(at); }, mesh);
  const TetAdjacency adjacency(mesh, "block");
  const FieldNodes nodes = testing::nodes_on(mesh, adjacency);
  std::vector<tetmesh::fields::Frame> frames;
  for (const Vec3& p : mesh.points) {
    const Vec3 out{p.x - centre_x, p.y - centre_y, 0};
    const Vec3 around = cross(up, unit(out));
    const Vec3 leaning_up = unit(up + (pitch / (2 * std::numbers::pi * norm(out))) * around);
    const double turn = std::atan2(out.y, out.x) / 4;
    const Vec3 first{std::cos(turn), std::sin(turn), 0};
    const Vec3 level = unit(first - dot(first, leaning_up) * leaning_up);
    frames.push_back({level, cross(leaning_up, level), leaning_up});
  }
  const auto rise = [&](const LatticeLinks& links, std::int32_t z) {
    double sum = 0;
    testing::Place at{0, 0, z};
    for (const auto& [axis, step] : {std::pair(0, 1), {1, 1}, {0, -1}, {1, -1}})
      for (std::int32_t i = 0; i < width; ++i) {
        const Vertex from = number.at(at);
        at[static_cast<std::size_t>(axis)] += step;
        sum += links[links.between(number.at(at), from)].distance[2];
      }
    return sum;
  };
  const LatticeField field = solve_lattice_field(nodes, frames, {});
  for (std::int32_t z = 0; z <= layers; ++z) {
    EXPECT_NEAR(rise(LatticeLinks(nodes, frames), z), pitch, 0.05);
    EXPECT_NEAR(rise(field.links, z), 0, 0.1) << "layer " << z;
  }
}

}  // namespace
}  // namespace hexpipe
