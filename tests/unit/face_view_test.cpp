#include "common/mesh/face_view.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "common/mesh/quality.hpp"
#include "common/mesh/validity.hpp"

namespace hexpipe {
namespace {

// A valid prism of a real part that gmshToFoam turns round.
constexpr std::array<Vec3, 6> warped_prism{{{.1, .13859, .21934},
                                            {.07927, .13784, .21934},
                                            {.1, .13645, .23754},
                                            {.1, .17926, .21308},
                                            {.07681, .17868, .21538},
                                            {.1, .17677, .21751}}};

TEST(FaceView, FindsThePrismThatReadersTurnRound) {
  EXPECT_TRUE(is_valid(CellKind::prism, warped_prism));
  EXPECT_GT(least_corner_scaled_jacobian(CellKind::prism, warped_prism), 0.12);
  EXPECT_LT(least_face_view(CellKind::prism, warped_prism), 0);
}

TEST(FaceView, IsTheCosineAtTheCornersOfABox) {
  const std::array<Vec3, 8> cube{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  EXPECT_NEAR(least_face_view(CellKind::hex, cube), 1 / std::sqrt(3.0), 1e-14);
  const std::array<Vec3, 6> upright{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
  EXPECT_GT(least_face_view(CellKind::prism, upright), 0.2);
}

TEST(FaceView, DependsOnNoSizeAndNoPlace) {
  std::array<Vec3, 6> moved = warped_prism;
  for (Vec3& p : moved) p = 1e-5 * p + Vec3{3e-5, -2e-5, 1e-5};
  EXPECT_NEAR(least_face_view(CellKind::prism, moved), least_face_view(CellKind::prism, warped_prism), 1e-9);
}

TEST(FaceView, IsNegativeForWhatIsInverted) {
  const std::array<Vec3, 4> tet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  EXPECT_GT(least_face_view(CellKind::tet, tet), 0);
  EXPECT_LT(least_face_view(CellKind::tet, std::array{tet[1], tet[0], tet[2], tet[3]}), 0);
  EXPECT_EQ(least_face_view(CellKind::tet, std::array{tet[0], tet[0], tet[2], tet[3]}), -1);
}

}  // namespace
}  // namespace hexpipe
