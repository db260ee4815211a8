#include <gtest/gtest.h>

#include "common/mesh/adjacency.hpp"
#include "tetmesh_surfaces.hpp"
#include "tools/tetmesh/volume/frame_field.hpp"
#include "tools/tetmesh/volume/lattice.hpp"

namespace hexpipe {
using namespace tetmesh::volume;
namespace {

using testing::mesh_of;
using testing::sphere;
using testing::surface_of;

struct Ball {
  tetmesh::solid::Surface surface = surface_of(sphere({0, 0, 0}, 1, 20));
  tetmesh::tetgen::BuiltMesh built = mesh_of(surface, lattice_points(surface, {.size = 0.16}));
  FieldNodes nodes = make_field_nodes(surface, built.mesh, built.adjacency, 0.16, 40);
};

TEST(FrameField, HasAnAxisAlongEachNormal) {
  const Ball ball;
  const auto frames = solve_frame_field(ball.nodes);
  ASSERT_EQ(frames.size(), ball.nodes.size());
  for (std::size_t i = 0; i < ball.nodes.surface.size(); ++i) {
    double along = 0;
    for (const Vec3& axis : frames[i]) along = std::max(along, std::abs(dot(axis, ball.nodes.surface[i].normal)));
    EXPECT_GT(along, 1 - 1e-9);
  }
}

// The mean over links of the squared difference of the frames' harmonics: 1.44 if the linear problem is projected once.
TEST(FrameField, IsSmoothInABall) {
  const Ball ball;
  const auto frames = solve_frame_field(ball.nodes);
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < ball.nodes.size(); ++i)
    for (const FieldLink& link : ball.nodes.links_of(i)) {
      const auto here = tetmesh::fields::harmonics_of(frames[i]),
                 there = tetmesh::fields::harmonics_of(frames[link.node]);
      sum += static_cast<double>(link.weight) * (here - there).squaredNorm();
      weights += static_cast<double>(link.weight);
    }
  EXPECT_LT(sum / weights, 1.37);
}

}  // namespace
}  // namespace hexpipe
