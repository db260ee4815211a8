#include "tools/tetmesh/volume/lattice_field.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hexpipe
