#include "common/mesh/face_measures.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace hexpipe {
namespace {

constexpr double degrees = std::numbers::pi / 180;

constexpr std::array<Vec3, 8> cube{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
// A unit square with its third corner lifted by 1.
constexpr std::array<Vec3, 4> warped{{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}};

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(FaceShape, OfATriangleAndASquare) {
  const FaceShape triangle = face_shape(std::array<Vec3, 3>{{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}});
  expect_near(triangle.area, {0, 0, 3});
  expect_near(triangle.centre, {2.0 / 3, 1, 0});
  const FaceShape square = face_shape(std::span(cube).last(4));
  expect_near(square.area, {0, 0, 1});
  expect_near(square.centre, {0.5, 0.5, 1});
}

// The triangles around (0.5, 0.5, 0.25) have 0.2795 and 0.375, each twice.
TEST(FaceShape, OfAWarpedQuadIsNearerToItsLargerTriangles) {
  const FaceShape face = face_shape(warped);
  expect_near(face.area, {-0.5, -0.5, 1});
  expect_near(face.centre, {0.524316, 0.524316, 0.274316}, 1e-6);
}

TEST(FaceShape, OfAPointIsNothing) {
  const FaceShape face = face_shape(std::array<Vec3, 4>{{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}});
  expect_near(face.area, {});
  expect_near(face.centre, {1, 2, 3});
}

TEST(CellCentre, IsTheCentreOfMassWhereFacesAreFlat) {
  expect_near(cell_centre(CellKind::hex, cube), {0.5, 0.5, 0.5});
  const std::array<Vec3, 5> pyramid{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}}};
  expect_near(cell_centre(CellKind::pyramid, pyramid), {0.5, 0.5, 0.25});
  const std::array<Vec3, 4> tet{{{0, 0, 0}, {4, 0, 0}, {0, 8, 0}, {0, 0, 12}}};
  expect_near(cell_centre(CellKind::tet, tet), {1, 2, 3});
  const std::array<Vec3, 6> prism{{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 2}, {3, 0, 2}, {0, 3, 2}}};
  expect_near(cell_centre(CellKind::prism, prism), {1, 1, 1});
}

TEST(FaceMeasures, OrthogonalityAndWeightFollowTheLineBetweenTheCentres) {
  const FaceShape face{{2, 0, 0}, {1, 0, 0}};
  EXPECT_NEAR(orthogonality(face, {}, {4, 0, 0}), 1, 1e-15);
  EXPECT_NEAR(orthogonality(face, {}, {2, 2, 0}), std::cos(45 * degrees), 1e-15);
  EXPECT_NEAR(orthogonality(face, {4, 0, 0}, {}), -1, 1e-15);
  EXPECT_NEAR(face_weight(face, {}, {4, 0, 0}), 0.25, 1e-15);
  EXPECT_NEAR(face_weight(face, {0, 5, 0}, {2, -7, 0}), 0.5, 1e-15) << "only the way across the face counts";
  EXPECT_NEAR(face_weight(face, {1, 0, 0}, {2, 0, 0}), 0, 1e-15);
}

}  // namespace
}  // namespace hexpipe
