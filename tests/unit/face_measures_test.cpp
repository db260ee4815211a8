#include "common/mesh/mesh_measures.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

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

// Corners 0 and 2 lie higher than 1 and 3, so that the diagonal 02 is a ridge, and 13 a valley, as seen from above.
TEST(FaceMeasures, ADiagonalSuitsBothCellsUnlessBothAreFlat) {
  const auto sight = [](double warp, double below, double above) {
    const std::array<Vec3, 4> quad{Vec3{0, 0, warp}, {1, 0, -warp}, {1, 1, warp}, {0, 1, -warp}};
    return diagonal_sight(quad, {0.5, 0.5, -below}, {0.5, 0.5, above});
  };
  EXPECT_NEAR(sight(0, 0.3, 0.2), 0.2, 1e-12);
  EXPECT_GT(sight(0.1, 0.05, 0.5), 0) << "the ridge is above the lower centre";
  EXPECT_GT(sight(0.1, 0.5, 0.05), 0) << "the valley is below the upper centre";
  EXPECT_LT(sight(0.1, 0.05, 0.05), 0);
  EXPECT_EQ(sight(0.1, 0.05, 0.05), sight(-0.1, 0.05, 0.05));
}

TEST(FaceMeasures, FlatnessFallsAsAQuadWarps) {
  EXPECT_NEAR(face_flatness(std::span(cube).first(4)), 1, 1e-15);
  EXPECT_EQ(face_flatness(std::span(warped).first(3)), 1);
  // sqrt(1.5) over twice 0.295872 and twice 0.358835.
  EXPECT_NEAR(face_flatness(warped), 0.935338, 1e-5);
  EXPECT_EQ(face_flatness(std::array<Vec3, 4>{}), 1);
}

TEST(FaceMeasures, TheDeterminantTellsWhichWaysACellHasNeighbours) {
  const auto of_cube = [](std::array<std::uint8_t, 6> inner) { return cell_determinant(CellKind::hex, cube, inner); };
  EXPECT_NEAR(of_cube({1, 1, 1, 1, 1, 1}), 1, 1e-15);
  EXPECT_NEAR(of_cube({0, 1, 1, 1, 1, 1}), 0.5, 1e-15);
  EXPECT_NEAR(of_cube({0, 0, 1, 1, 1, 1}), 0, 1e-15) << "a row of cubes in a plane";
  EXPECT_EQ(of_cube({0, 0, 0, 0, 0, 0}), 0);
  // Faces of 1 and 4, mean 3: 2 (1/3)^2 2 (4/3)^2 2 (4/3)^2 / 8.
  std::array<Vec3, 8> tall = cube;
  for (Vec3& p : tall) p.z *= 4;
  EXPECT_NEAR(cell_determinant(CellKind::hex, tall, std::array<std::uint8_t, 6>{1, 1, 1, 1, 1, 1}), 256.0 / 729, 1e-12);
  const std::array<Vec3, 4> tet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  EXPECT_EQ(cell_determinant(CellKind::tet, tet, std::array<std::uint8_t, 4>{1, 1, 0, 0}), 0);
  EXPECT_GT(cell_determinant(CellKind::tet, tet, std::array<std::uint8_t, 4>{1, 1, 1, 1}), 0.1);
}

// A cube, and one behind it whose far side is two away and `shift` to the side.
MixedMesh pair(double shift) {
  MixedMesh mesh;
  mesh.points.assign(cube.begin(), cube.end());
  for (const int near : {1, 2, 5, 6}) mesh.points.push_back(cube[near] + Vec3{2, shift, 0});
  mesh.hexes.cells = {{0, 1, 2, 3, 4, 5, 6, 7}, {1, 8, 9, 2, 5, 10, 11, 6}};
  return mesh;
}

TEST(MeshMeasures, CountFacesAndCellsBeyondTheLimits) {
  MeshMeasures found = measure_mesh(pair(2));
  EXPECT_EQ(found.faces, 11);
  EXPECT_EQ(found.inner_faces, 1);
  EXPECT_EQ(found.angle.misses, 0);
  EXPECT_EQ(found.weight.misses, 0);
  EXPECT_EQ(found.determinant.misses, 2) << "one neighbour each";
  EXPECT_EQ(found.flatness.misses, 0);
  EXPECT_NEAR(found.angle.worst, std::atan(1 / 1.5), 1e-12);
  EXPECT_NEAR(found.mean_angle, found.angle.worst, 1e-12);
  EXPECT_NEAR(found.weight.worst, 1.0 / 3, 1e-12);
  expect_near(found.angle.place, {1, 0.5, 0.5});
  found = measure_mesh(pair(2), {.angle = 30 * degrees, .weight = 0.34});
  EXPECT_EQ(found.angle.misses, 1);
  EXPECT_EQ(found.angle.cells, 2);
  EXPECT_EQ(found.weight.misses, 1);
  found = measure_mesh(pair(12));
  EXPECT_EQ(found.angle.misses, 1);
  EXPECT_NEAR(found.angle.worst, std::atan(6 / 1.5), 1e-12);
  MixedMesh thin = pair(0);
  for (std::size_t i = 8; i < 12; ++i) thin.points[i].x = 1.02;
  found = measure_mesh(thin);
  EXPECT_EQ(found.weight.misses, 1);
  EXPECT_NEAR(found.weight.worst, 0.01 / 0.51, 1e-12);
  EXPECT_EQ(measure_mesh(MixedMesh{}).faces, 0);
}

TEST(MeshMeasures, FlatnessIsThatOfTheBoundaryToo) {
  MixedMesh bent = pair(0);
  bent.points[8].z = 5;
  const MeshMeasures found = measure_mesh(bent);
  EXPECT_GT(found.flatness.misses, 0);
  EXPECT_EQ(found.flatness.cells, 1);
  EXPECT_LT(found.flatness.worst, low_flatness);
}

// 27 cubes, of which one, in the middle, has six neighbours.
TEST(MeshMeasures, OfEachCellAreTheWorstOfItsFaces) {
  MixedMesh mesh;
  const auto point = [](int x, int y, int z) { return x + 4 * y + 16 * z; };
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) mesh.points.push_back({1.0 * x, 1.0 * y, 1.0 * z});
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x)
        mesh.hexes.cells.push_back({point(x, y, z), point(x + 1, y, z), point(x + 1, y + 1, z), point(x, y + 1, z),
                                    point(x, y, z + 1), point(x + 1, y, z + 1), point(x + 1, y + 1, z + 1),
                                    point(x, y + 1, z + 1)});
  const MeasuresOfCells regular = measure_cells(mesh);
  EXPECT_NEAR(regular.determinant[13], 1, 1e-12);
  EXPECT_NEAR(regular.determinant[12], 0.5, 1e-12);
  EXPECT_NEAR(regular.determinant[0], 0.125, 1e-12);
  EXPECT_NEAR(regular.orthogonality[0], 1, 1e-12);
  EXPECT_NEAR(regular.weight[0], 0.5, 1e-12);
  mesh.points[point(3, 3, 3)] = {6, 6, 3};
  const MeasuresOfCells bent = measure_cells(mesh);
  EXPECT_LT(bent.orthogonality[26], 0.99);
  EXPECT_LT(bent.weight[26], 0.45);
  EXPECT_LT(bent.orthogonality[25], 0.99) << "a neighbour has the face, too";
  EXPECT_NEAR(bent.orthogonality[0], 1, 1e-12);
}

}  // namespace
}  // namespace hexpipe
