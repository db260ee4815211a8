#include "common/mesh/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cell_shapes.hpp"
#include "common/mesh/jacobian.hpp"

namespace hexpipe {
namespace {

constexpr CellKind all_kinds[] = {CellKind::hex, CellKind::prism, CellKind::pyramid, CellKind::tet};

// By the definition, on a fine grid: an upper bound of the true minimum, close to it.
double sampled_scaled_jacobian(CellKind kind, const std::vector<Vec3>& corners, int steps) {
  double least = 1;
  for_each_parameter(kind, steps, [&](double i, double j, double k) {
    const Tangents t = tangents_at(kind, corners, i, j, k);
    least = std::min(least, scaled_jacobian(t.i, t.j, t.k));
    if (kind == CellKind::prism) {
      least = std::min(least, scaled_jacobian(t.j - t.i, -t.i, t.k));
      least = std::min(least, scaled_jacobian(-t.j, t.i - t.j, t.k));
    }
  });
  return least;
}

TEST(ScaledJacobian, IsOneForABoxAndIgnoresScale) {
  EXPECT_DOUBLE_EQ(scaled_jacobian({2, 0, 0}, {0, 3, 0}, {0, 0, 0.1}), 1);
  EXPECT_DOUBLE_EQ(scaled_jacobian({0, 3, 0}, {2, 0, 0}, {0, 0, 0.1}), -1);
  EXPECT_EQ(scaled_jacobian({0, 0, 0}, {2, 0, 0}, {0, 0, 0.1}), 0);
}

// (1, 0, 0), (1, 1, 0), (0, 1, 1) has just 0.5; through square roots it comes out as 0.49999999999999994.
TEST(ScaledJacobian, ThresholdIsStrictAndExactOnLattices) {
  const Vec3 u{1, 0, 0}, v{1, 1, 0}, w{0, 1, 1};
  EXPECT_FALSE(scaled_jacobian_exceeds(u, v, w, 0.5));
  EXPECT_TRUE(scaled_jacobian_exceeds(u, v, w, 0.5 - 1e-15));
  EXPECT_FALSE(scaled_jacobian_exceeds(v, u, w, 0));
  EXPECT_FALSE(scaled_jacobian_exceeds(u, u, w, 0));
  EXPECT_TRUE(scaled_jacobian_exceeds(u, v, w, 0));
}

TEST(Quality, OfRegularCells) {
  EXPECT_DOUBLE_EQ(least_corner_scaled_jacobian(CellKind::hex, unit_cell(CellKind::hex)), 1);
  EXPECT_DOUBLE_EQ(least_corner_scaled_jacobian(CellKind::prism, unit_cell(CellKind::prism)), std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(least_corner_scaled_jacobian(CellKind::pyramid, unit_cell(CellKind::pyramid)), std::sqrt(2.0 / 3));
  EXPECT_DOUBLE_EQ(least_corner_scaled_jacobian(CellKind::tet, unit_cell(CellKind::tet)), 0.5);
  for (const CellKind kind : all_kinds)
    EXPECT_DOUBLE_EQ(least_scaled_jacobian(kind, unit_cell(kind)), least_corner_scaled_jacobian(kind, unit_cell(kind)))
        << name_of(kind);
}

// Both ends of the bottom are turned the same way against the top: right angles at all corners, 60 degrees in the
// middle.
TEST(Quality, FindsAMinimumInsideTheElement) {
  const std::vector<Vec3> twisted = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0},   {-1, 1, 0},
                                     {-1, -1, 1}, {1, -1, 1}, {1, 1, 2.5}, {-1, 1, -0.2}};
  const double corner = least_corner_scaled_jacobian(CellKind::hex, twisted);
  const double element = least_scaled_jacobian(CellKind::hex, twisted);
  EXPECT_LE(element, corner);
  EXPECT_NEAR(element, sampled_scaled_jacobian(CellKind::hex, twisted, 64), quality_tolerance);
}

TEST(Quality, ElementMinimumAgreesWithSampling) {
  Random random(1);
  int inside = 0;
  for (const CellKind kind : {CellKind::hex, CellKind::prism, CellKind::pyramid})
    for (int n = 0; n < 60; ++n) {
      const auto corners = shaken_cell(kind, random.uniform(0, 0.3), random);
      const double corner = least_corner_scaled_jacobian(kind, corners);
      const double element = least_scaled_jacobian(kind, corners);
      const double sampled = sampled_scaled_jacobian(kind, corners, 24);
      EXPECT_LE(element, corner) << name_of(kind) << " " << n;
      if (sampled <= 0) {
        EXPECT_LE(element, 0.01) << name_of(kind) << " " << n;
        continue;
      }
      EXPECT_GE(sampled, element - quality_tolerance - 1e-12) << name_of(kind) << " " << n;
      EXPECT_LE(sampled, element + 0.01) << name_of(kind) << " " << n;
      inside += element < corner;
    }
  EXPECT_GT(inside, 20) << "the test is to meet minima that are at no corner";
}

TEST(Quality, IsTheSameFromAllCorners) {
  Random random(2);
  for (int n = 0; n < 50; ++n) {
    const auto p = shaken_cell(CellKind::hex, 0.25, random);
    const std::vector<Vec3> turned = {p[1], p[2], p[3], p[0], p[5], p[6], p[7], p[4]};
    EXPECT_NEAR(least_scaled_jacobian(CellKind::hex, p), least_scaled_jacobian(CellKind::hex, turned),
                quality_tolerance);
    EXPECT_NEAR(cell_volume(CellKind::hex, p), cell_volume(CellKind::hex, turned), 1e-12);
  }
}

TEST(Volume, OfRegularCells) {
  EXPECT_DOUBLE_EQ(cell_volume(CellKind::hex, unit_cell(CellKind::hex)), 1);
  EXPECT_DOUBLE_EQ(cell_volume(CellKind::prism, unit_cell(CellKind::prism)), 0.5);
  EXPECT_DOUBLE_EQ(cell_volume(CellKind::pyramid, unit_cell(CellKind::pyramid)), 1.0 / 3);
  EXPECT_DOUBLE_EQ(cell_volume(CellKind::tet, unit_cell(CellKind::tet)), 1.0 / 6);
}

// Simpson's rule is exact for the Jacobians of all kinds: they are at most quadratic along a parameter. Over the
// prism's triangle, where they are linear, the mean of the corners does.
double integrated_volume(CellKind kind, const std::vector<Vec3>& p) {
  constexpr double simpson[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
  double volume = 0;
  auto jacobian = [&](double i, double j, double k) {
    const Tangents t = tangents_at(kind, p, i, j, k);
    return det(t.i, t.j, t.k);
  };
  for (int c = 0; c < 3; ++c) {
    if (kind == CellKind::prism) {
      volume += simpson[c] / 6 * (jacobian(0, 0, c / 2.0) + jacobian(1, 0, c / 2.0) + jacobian(0, 1, c / 2.0));
      continue;
    }
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) volume += simpson[a] * simpson[b] * simpson[c] * jacobian(a / 2.0, b / 2.0, c / 2.0);
  }
  // The pyramid's Jacobian falls with the square of the height: a third remains.
  return kind == CellKind::pyramid ? volume / 3 : volume;
}

TEST(Volume, GrowsByItsGradientAsACornerMoves) {
  Random random(4);
  for (const CellKind kind : all_kinds)
    for (int corner = 0; corner < corner_count(kind); ++corner) {
      auto corners = shaken_cell(kind, 0.4, random);
      const double before = cell_volume(kind, corners);
      const Vec3 gradient = cell_volume_gradient(kind, corners, corner), step{0.3, -0.7, 0.2};
      corners[corner] += step;
      EXPECT_NEAR(cell_volume(kind, corners), before + dot(gradient, step), 1e-14) << name_of(kind);
    }
}

TEST(Volume, IsTheIntegralOfTheJacobian) {
  Random random(3);
  for (const CellKind kind : {CellKind::hex, CellKind::prism, CellKind::pyramid})
    for (int n = 0; n < 50; ++n) {
      const auto corners = shaken_cell(kind, 0.4, random);
      EXPECT_NEAR(cell_volume(kind, corners), integrated_volume(kind, corners), 1e-13) << name_of(kind);
    }
}

double bernstein(int index, double t) {
  return index == 0 ? (1 - t) * (1 - t) : index == 1 ? 2 * t * (1 - t) : t * t;
}

TEST(HexJacobian, BezierFormIsTheJacobian) {
  Random random(4);
  for (int n = 0; n < 50; ++n) {
    const auto p = shaken_cell(CellKind::hex, 0.5, random);
    const auto bezier = HexJacobian<Vec3>(HexTangents<Vec3>(p)).bezier();
    const double i = random.uniform(), j = random.uniform(), k = random.uniform();
    double value = 0;
    for (int c = 0; c < 27; ++c)
      value += bezier[c] / 8 * bernstein(c / 9, i) * bernstein(c / 3 % 3, j) * bernstein(c % 3, k);
    const Tangents t = tangents_at(CellKind::hex, p, i, j, k);
    EXPECT_NEAR(value, det(t.i, t.j, t.k), 1e-13);
  }
}

TEST(HexJacobian, DeterminantsAreThoseOfTheMap) {
  Random random(5);
  const auto p = shaken_cell(CellKind::hex, 0.5, random);
  std::vector<double> expected, found;
  for_each_parameter(CellKind::hex, 2, [&](double i, double j, double k) {
    const int middles = (i == 0.5) + (j == 0.5) + (k == 0.5);
    const Tangents t = tangents_at(CellKind::hex, p, i, j, k);
    if (middles < 2) expected.push_back((middles == 1 ? 4 : 1) * det(t.i, t.j, t.k));
  });
  HexJacobian<Vec3>(HexTangents<Vec3>(p)).all_determinants([&](double value) {
    found.push_back(value);
    return true;
  });
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found.size(), 20u);
  for (std::size_t c = 0; c < 20; ++c) EXPECT_NEAR(found[c], expected[c], 1e-14);
}

TEST(PrismJacobian, BezierFormIsTheJacobian) {
  Random random(6);
  const auto p = shaken_cell(CellKind::prism, 0.4, random);
  const auto bezier = prism_bezier<Vec3>(p);
  for (int n = 0; n < 50; ++n) {
    const double i = random.uniform(0, 0.5), j = random.uniform(0, 0.5), k = random.uniform();
    const double over_triangle[3] = {1 - i - j, i, j};
    double value = 0;
    for (int e = 0; e < 3; ++e)
      for (int level = 0; level < 3; ++level) value += over_triangle[e] * bernstein(level, k) * bezier[e][level] / 2;
    const Tangents t = tangents_at(CellKind::prism, p, i, j, k);
    EXPECT_NEAR(value, det(t.i, t.j, t.k), 1e-14);
  }
}

// The parts together are the whole, and each is a cell of the same kind.
TEST(Split, KeepsTheVolume) {
  Random random(7);
  auto check = [&]<std::size_t Size>(CellKind kind, std::array<Vec3, Size> corners, double scale) {
    const auto shaken = shaken_cell(kind, 0.2, random);
    std::copy(shaken.begin(), shaken.end(), corners.begin());
    double volume = 0;
    for (const auto& part : split(corners)) volume += cell_volume(kind, part);
    EXPECT_NEAR(volume, scale * scale * scale * cell_volume(kind, corners), 1e-10) << name_of(kind);
  };
  check(CellKind::hex, std::array<Vec3, 8>{}, 8);
  check(CellKind::prism, std::array<Vec3, 6>{}, 4);
  check(CellKind::pyramid, std::array<Vec3, 5>{}, 4);
}

}  // namespace
}  // namespace hexpipe
