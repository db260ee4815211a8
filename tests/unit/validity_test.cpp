#include "common/mesh/validity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cell_shapes.hpp"
#include "common/mesh/cell_measures.hpp"
#include "common/mesh/quality.hpp"
#include "tests/unit/random_cases.hpp"

namespace hexpipe {
namespace {

constexpr CellKind all_kinds[] = {CellKind::hex, CellKind::prism, CellKind::pyramid, CellKind::tet};

std::vector<Vec3> mapped(std::vector<Vec3> corners, double scale, const Vec3& shift) {
  for (Vec3& p : corners) p = scale * p + shift;
  return corners;
}

double least_sampled_jacobian(CellKind kind, const std::vector<Vec3>& corners, int steps) {
  double least = std::numeric_limits<double>::infinity();
  for_each_parameter(kind, steps, [&](double i, double j, double k) {
    const Tangents t = tangents_at(kind, corners, i, j, k);
    least = std::min(least, det(t.i, t.j, t.k));
  });
  return least;
}

TEST(Orientation, HasAllThreeSigns) {
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orientation({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}), -1);
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.2, 0}), 0);
  EXPECT_EQ(orientation({1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}), 0);
}

// Four points of a plane, the last moved by one unit in the last place: a plain determinant gives noise.
TEST(Orientation, SeesTheLastBit) {
  const double tenth = 0.1;
  for (int n = 1; n < 200; ++n) {
    const Vec3 a{n * tenth, 0.7, 1e6}, b{n * tenth + 3, 0.7, 1e6 + 3}, c{n * tenth, 1.1, 1e6}, d{n * tenth + 5, 9.3, 0};
    // On the plane through a, b, c: z - 1e6 = x - n / 10, all of it exact but the x that is chosen here.
    const Vec3 on{d.x, d.y, 1e6 + (d.x - a.x)};
    const int at = orientation(a, b, c, on);
    const Vec3 above{on.x, on.y, std::nextafter(on.z, 2e6)}, below{on.x, on.y, std::nextafter(on.z, 0)};
    EXPECT_LE(orientation(a, b, c, below), at);
    EXPECT_GE(orientation(a, b, c, above), at);
    EXPECT_NE(orientation(a, b, c, above), orientation(a, b, c, below));
  }
}

TEST(Orientation, TakesTheSmallestAndGreatestNumbers) {
  const double tiny = std::numeric_limits<double>::denorm_min(), huge = std::numeric_limits<double>::max();
  EXPECT_EQ(orientation({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}), 1);
  EXPECT_EQ(orientation({0, 0, 0}, {huge, 0, 0}, {0, huge, 0}, {0, 0, -huge}), -1);
  EXPECT_EQ(orientation({-huge, 0, 0}, {huge, 0, 0}, {0, tiny, 0}, {0, 0, tiny}), 1);
}

TEST(Validity, OfRegularCellsAndTheirMirrorImages) {
  for (const CellKind kind : all_kinds) {
    auto corners = unit_cell(kind);
    EXPECT_TRUE(is_valid(kind, corners)) << name_of(kind);
    for (Vec3& p : corners) p.x = -p.x;
    EXPECT_FALSE(is_valid(kind, corners)) << name_of(kind);
    for (Vec3& p : corners) p.x = 0;
    EXPECT_FALSE(is_valid(kind, corners)) << name_of(kind);
  }
}

// Sampling can only show that a cell is not valid; where the least sample is well positive, the cell is.
TEST(Validity, AgreesWithSampling) {
  Random random(1);
  int valid = 0, invalid = 0;
  for (const CellKind kind : all_kinds)
    for (int n = 0; n < hexpipe::testing::random_cases(300); ++n) {
      const auto corners = shaken_cell(kind, random.uniform(0.2, 0.6), random);
      const double least = least_sampled_jacobian(kind, corners, 16);
      if (least <= 0) {
        EXPECT_FALSE(is_valid(kind, corners)) << name_of(kind) << " " << n;
        ++invalid;
      } else if (least > 0.02) {
        EXPECT_TRUE(is_valid(kind, corners)) << name_of(kind) << " " << n;
        ++valid;
      }
    }
  EXPECT_GT(valid, hexpipe::testing::random_cases(200));
  EXPECT_GT(invalid, hexpipe::testing::random_cases(100));
}

// Positive at all eight corners, negative between them.
TEST(Validity, CornersAreNotEnough) {
  Random random(2);
  int found = 0;
  for (int n = 0; n < hexpipe::testing::random_cases(3000); ++n) {
    const auto corners = shaken_cell(CellKind::hex, 0.5, random);
    if (least_corner_scaled_jacobian(CellKind::hex, corners) <= 0) continue;
    if (least_sampled_jacobian(CellKind::hex, corners, 8) > 0) continue;
    EXPECT_FALSE(is_valid(CellKind::hex, corners));
    ++found;
  }
  EXPECT_GT(found, hexpipe::testing::random_cases(5));
}

TEST(Validity, SeesTheLastBitOfACorner) {
  auto hex = [](double height) {
    std::vector<Vec3> p = unit_cell(CellKind::hex);
    p[5].z = height;
    return p;
  };
  EXPECT_TRUE(is_valid(CellKind::hex, hex(0.5)));
  EXPECT_TRUE(is_valid(CellKind::hex, hex(1e-300)));
  EXPECT_FALSE(is_valid(CellKind::hex, hex(0)));
  EXPECT_FALSE(is_valid(CellKind::hex, hex(-1e-300)));
}

// A square that turns by almost half a circle on its way along i: the Jacobian is (1 - 2 i)^2 + s^2 i^2, at least about
// s^2 / 4. In doubles that is 0 for these s; half a circle makes it 0.
TEST(Validity, SeesWhatDoublesCannot) {
  auto turned = [](double s) {
    return std::vector<Vec3>{{0, 0, 0}, {1, 0, 0},   {1, -1, s},          {0, 1, 0},
                             {0, 0, 1}, {1, -s, -1}, {1, -1 - s, -1 + s}, {0, 1, 1}};
  };
  EXPECT_TRUE(is_valid(CellKind::hex, turned(0x1p-20)));
  EXPECT_TRUE(is_valid(CellKind::hex, turned(0x1p-50)));
  EXPECT_TRUE(is_valid(CellKind::hex, turned(-0x1p-50)));
  EXPECT_FALSE(is_valid(CellKind::hex, turned(0)));
}

// The same cell, exactly: scaled by powers of two, and moved where that loses no bit.
TEST(Validity, DoesNotDependOnScaleAndPlace) {
  Random random(3);
  for (const CellKind kind : all_kinds)
    for (int n = 0; n < 60; ++n) {
      auto corners = shaken_cell(kind, 0.5, random);
      for (Vec3& p : corners) p = {std::round(p.x * 64) / 64, std::round(p.y * 64) / 64, std::round(p.z * 64) / 64};
      const bool valid = is_valid(kind, corners);
      for (const double scale : {0x1p-400, 0x1p-100, 0x1p20, 0x1p300})
        EXPECT_EQ(is_valid(kind, mapped(corners, scale, {})), valid) << name_of(kind) << " " << n << " " << scale;
      EXPECT_EQ(is_valid(kind, mapped(corners, 1, {0x1p40, -0x1p45, 0x1p30})), valid) << name_of(kind) << " " << n;
    }
}

// On a coarse grid zero determinants are common; each kind's answer must be that of all its labellings.
TEST(Validity, IsTheSameForAllLabellings) {
  Random random(4);
  int valid = 0;
  for (int n = 0; n < 400; ++n) {
    auto p = shaken_cell(CellKind::hex, 0.6, random);
    for (Vec3& q : p) q = {std::round(q.x * 3), std::round(q.y * 3), std::round(q.z * 3)};
    const std::vector<Vec3> turned = {p[1], p[2], p[3], p[0], p[5], p[6], p[7], p[4]};
    const std::vector<Vec3> tipped = {p[0], p[4], p[5], p[1], p[3], p[7], p[6], p[2]};
    EXPECT_EQ(is_valid(CellKind::hex, p), is_valid(CellKind::hex, turned)) << n;
    EXPECT_EQ(is_valid(CellKind::hex, p), is_valid(CellKind::hex, tipped)) << n;
    valid += is_valid(CellKind::hex, p);
  }
  EXPECT_GT(valid, 50);
}

// A triangle that turns on its way up: the Jacobian is (1 - k)^2 + 2 c k (1 - k) + k^2 with the cosine c of the turn.
// From a right angle on the middle Bezier coefficient is no longer positive; only at half a circle the Jacobian touches
// 0.
TEST(Validity, OfAPrismIsDecidedWithoutSubdivision) {
  auto turned = [](double cosine, double sine) {
    std::vector<Vec3> p = unit_cell(CellKind::prism);
    p[4] = {cosine, sine, 1};
    p[5] = {-sine, cosine, 1};
    return p;
  };
  EXPECT_TRUE(is_valid(CellKind::prism, turned(1, 0)));
  EXPECT_TRUE(is_valid(CellKind::prism, turned(-0.6, 0.8)));
  EXPECT_TRUE(is_valid(CellKind::prism, turned(-1, 0x1p-50)));
  EXPECT_FALSE(is_valid(CellKind::prism, turned(-1, 0)));
}

TEST(Validity, OfAPyramidIsThatOfItsBaseCorners) {
  auto corners = unit_cell(CellKind::pyramid);
  corners[2] = {0.5, 0.5, 0};  // corner 2 of the base is straight
  EXPECT_FALSE(is_valid(CellKind::pyramid, corners));
  corners[2] = {0.51, 0.51, 0};
  EXPECT_TRUE(is_valid(CellKind::pyramid, corners));
  corners[4].z = 0;
  EXPECT_FALSE(is_valid(CellKind::pyramid, corners));
}

// Measured with others a cell has the same bits as alone, and no hex is sure that is not valid.
TEST(SideBySide, HexesAreAsTheyAreAlone) {
  Random random(7);
  int sure = 0, valid = 0;
  for (int round = 0; round < 2000; ++round) {
    std::array<std::array<Vec3, 8>, lane_count> hexes;
    for (auto& hex : hexes) {
      const auto corners = mapped(shaken_cell(CellKind::hex, 0.45, random), 1e-3, {1e3, 0, -7});
      std::copy(corners.begin(), corners.end(), hex.begin());
    }
    const auto together = side_by_side(hexes);
    const std::uint32_t surely_valid = surely_valid_hexes(together);
    CellMeasures measures;
    measure_cells(together, measures);
    for (int lane = 0; lane < lane_count; ++lane) {
      EXPECT_EQ(measures.quality[lane], least_corner_scaled_jacobian(CellKind::hex, hexes[lane]));
      EXPECT_EQ(measures.volume[lane], cell_volume(CellKind::hex, hexes[lane]));
      const bool is_surely = (surely_valid >> lane & 1) != 0, is = is_valid(CellKind::hex, hexes[lane]);
      EXPECT_LE(is_surely, is);
      sure += is_surely ? 1 : 0;
      valid += is ? 1 : 0;
    }
  }
  EXPECT_GT(sure, valid / 2);
  EXPECT_LT(valid, 2000 * lane_count);
}

TEST(SideBySide, HexesOfNoSizeOrTooMuchAreNotSure) {
  for (const double scale : {0.0, 1e-100, 1e100, 1e200}) {
    std::array<std::array<Vec3, 8>, lane_count> hexes;
    const auto corners = mapped(unit_cell(CellKind::hex), scale, {});
    for (auto& hex : hexes) std::copy(corners.begin(), corners.end(), hex.begin());
    EXPECT_EQ(surely_valid_hexes(side_by_side(hexes)), 0u) << scale;
  }
}

}  // namespace
}  // namespace hexpipe
