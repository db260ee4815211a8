#include "tools/tessellate/crossings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "common/run/random.hpp"

namespace hexpipe::tessellate {
namespace {

using Pair = std::array<std::int32_t, 2>;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::vector<Vec3> corners{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};

// A triangle of the three corners, and another one.
std::vector<Pair> crossings(std::vector<Vec3> more, const Triangle& other) {
  std::vector<Vec3> points = corners;
  points.insert(points.end(), more.begin(), more.end());
  return crossing_triangles(points, std::vector<Triangle>{{0, 1, 2}, other});
}

TEST(Crossings, TrianglesWithoutCommonCorners) {
  EXPECT_THAT(crossings({{1, 1, -1}, {1, 1, 1}, {9, 9, 1}}, {3, 4, 5}), ElementsAre(Pair{0, 1}));
  EXPECT_THAT(crossings({{1, 1, 1}, {2, 1, 1}, {1, 2, 1}}, {3, 4, 5}), IsEmpty());
  // It touches with a corner, overlaps in the plane, lies inside.
  EXPECT_THAT(crossings({{1, 1, 0}, {2, 1, 1}, {1, 2, 1}}, {3, 4, 5}), ElementsAre(Pair{0, 1}));
  EXPECT_THAT(crossings({{1, 1, 0}, {8, 1, 0}, {8, 8, 0}}, {3, 4, 5}), ElementsAre(Pair{0, 1}));
  EXPECT_THAT(crossings({{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}, {3, 4, 5}), ElementsAre(Pair{0, 1}));
  EXPECT_THAT(crossings({{3, 3, 0}, {8, 1, 0}, {8, 8, 0}}, {3, 4, 5}), IsEmpty());
}

TEST(Crossings, TrianglesWithCommonCorners) {
  EXPECT_THAT(crossings({{-1, 0, 0}, {0, -1, 0}}, {0, 3, 4}), IsEmpty());
  EXPECT_THAT(crossings({{3, 3, -1}, {3, 3, 1}}, {0, 3, 4}), ElementsAre(Pair{0, 1}));
  EXPECT_THAT(crossings({{1, 1, 0}, {1, 1, 1}}, {0, 3, 4}), ElementsAre(Pair{0, 1}));
  EXPECT_THAT(crossings({{1, -1, 0}}, {1, 0, 3}), IsEmpty());
  EXPECT_THAT(crossings({{1, 1, 1}}, {1, 0, 3}), IsEmpty());
  EXPECT_THAT(crossings({{1, 1, 0}}, {1, 0, 3}), ElementsAre(Pair{0, 1}));
}

TEST(Crossings, LeavesToTetmeshWhatItMends) {
  EXPECT_THAT(crossings({}, {1, 0, 2}), IsEmpty());
  // A triangle without area on the edge 01, and the one that is at its middle corner.
  const std::vector<Vec3> points{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, 0, 0}, {2, -1, 0}};
  EXPECT_THAT(crossing_triangles(points, std::vector<Triangle>{{0, 1, 2}, {1, 0, 3}, {3, 0, 4}, {1, 3, 4}}), IsEmpty());
}

// By Cramer's rule in whole numbers: where a segment meets the plane of a triangle.
using Whole = std::int64_t;
using Vector = std::array<Whole, 3>;

Vector minus(const Vec3& a, const Vec3& b) {
  return {static_cast<Whole>(a.x - b.x), static_cast<Whole>(a.y - b.y), static_cast<Whole>(a.z - b.z)};
}
Whole determinant(const Vector& a, const Vector& b, const Vector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}
bool crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  // a + u (b - a) + v (c - a) = p + t (q - p)
  const Vector ab = minus(b, a), ac = minus(c, a), qp = minus(p, q), ap = minus(p, a);
  const Whole whole = determinant(ab, ac, qp);
  if (whole == 0) return false;
  const Whole sign = whole > 0 ? 1 : -1;
  const Whole u = sign * determinant(ap, ac, qp), v = sign * determinant(ab, ap, qp),
              t = sign * determinant(ab, ac, ap);
  return u >= 0 && v >= 0 && u + v <= sign * whole && t >= 0 && t <= sign * whole;
}

TEST(Crossings, AgreeWithWholeNumbers) {
  Random random(1);
  int crossed = 0, apart = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<Vec3> points;
    const auto coordinate = [&] { return static_cast<double>(random.below(6)); };
    for (int i = 0; i < 6; ++i) points.push_back({coordinate(), coordinate(), coordinate()});
    bool are_in_one_plane = true;
    const auto side = [&](int k) {
      return determinant(minus(points[1], points[0]), minus(points[2], points[0]), minus(points[k], points[0]));
    };
    for (int k = 3; k < 6; ++k) are_in_one_plane = are_in_one_plane && side(k) == 0;
    const Vec3 normal = cross(points[4] - points[3], points[5] - points[3]);
    if (are_in_one_plane || norm_squared(normal) == 0) continue;
    bool expected = false;
    for (int k = 0; k < 3; ++k) {
      expected = expected || crosses(points[k], points[(k + 1) % 3], points[3], points[4], points[5]);
      expected = expected || crosses(points[3 + k], points[3 + (k + 1) % 3], points[0], points[1], points[2]);
    }
    // Edges in the plane of the other triangle are for the tests above.
    bool edge_in_plane = false;
    for (int k = 0; k < 3; ++k) edge_in_plane = edge_in_plane || (side(3 + k) == 0 && side(3 + (k + 1) % 3) == 0);
    const auto other_side = [&](int k) {
      return determinant(minus(points[4], points[3]), minus(points[5], points[3]), minus(points[k], points[3]));
    };
    for (int k = 0; k < 3; ++k) edge_in_plane = edge_in_plane || (other_side(k) == 0 && other_side((k + 1) % 3) == 0);
    if (edge_in_plane) continue;
    const bool found = !crossing_triangles(points, std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}).empty();
    ASSERT_EQ(found, expected) << "round " << round;
    ++(expected ? crossed : apart);
  }
  EXPECT_GT(crossed, 100);
  EXPECT_GT(apart, 100);
}

}  // namespace
}  // namespace hexpipe::tessellate
