#include "tools/tetmesh/volume/row_straightening.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hexpipe {
using namespace tetmesh::volume;
namespace {

constexpr int layers = 5, columns = 10;

// Layers along x, rows along y, and one row above the other along z. In each layer the middle row is a pair of rows,
// `apart` from each other, up to and with column last_pairs[layer].
std::vector<Vec3> rows_that_end(const std::array<int, layers>& last_pairs, double apart = 0.7) {
  std::vector<Vec3> points;
  for (int layer = 0; layer < layers; ++layer)
    for (int column = 0; column < columns; ++column) {
      const bool is_pair = column <= last_pairs[layer];
      for (const double z : {-2.5, -1.4, 1.4, 2.5}) points.push_back({double(layer), double(column), z});
      if (is_pair) {
        points.push_back({double(layer), double(column), -apart / 2});
        points.push_back({double(layer), double(column), apart / 2});
      } else {
        points.push_back({double(layer), double(column), 0});
      }
    }
  return points;
}

std::vector<RowPoint> with_steps(const std::vector<Vec3>& points) {
  std::vector<RowPoint> rows;
  for (const Vec3& p : points) rows.push_back({p, {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  return rows;
}

// The last column with a pair, by layer.
std::array<int, layers> last_pairs_of(const std::vector<RowPoint>& rows) {
  std::array<int, layers> last;
  last.fill(-1);
  for (const RowPoint& row : rows)
    if (std::abs(row.at.z) > 0.1 && std::abs(row.at.z) < 1) {
      int& of_layer = last[static_cast<std::size_t>(row.at.x)];
      of_layer = std::max(of_layer, static_cast<int>(row.at.y));
    }
  return last;
}

using Ends = std::array<int, layers>;

TEST(RowStraightening, MovesAStepOutOfTheModel) {
  const auto rows = straighten_row_ends({}, with_steps(rows_that_end({5, 5, 4, 4, 4})));
  EXPECT_EQ(last_pairs_of(rows), (Ends{4, 4, 4, 4, 4}));
  EXPECT_EQ(rows.size(), rows_that_end({4, 4, 4, 4, 4}).size());
  for (const RowPoint& row : rows) EXPECT_EQ(row.at.x, std::round(row.at.x));
}

TEST(RowStraightening, MovesStepsOfSeveralCellsAndBulges) {
  EXPECT_EQ(last_pairs_of(straighten_row_ends({}, with_steps(rows_that_end({7, 6, 6, 4, 4})))), (Ends{4, 4, 4, 4, 4}));
  EXPECT_EQ(last_pairs_of(straighten_row_ends({}, with_steps(rows_that_end({4, 4, 5, 4, 4})))), (Ends{4, 4, 4, 4, 4}));
}

TEST(RowStraightening, LeavesAStraightEndAsItIs) {
  const auto points = rows_that_end({5, 5, 5, 5, 5});
  const auto rows = straighten_row_ends({}, with_steps(points));
  ASSERT_EQ(rows.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(rows[i].at, points[i]);
}

TEST(RowStraightening, LeavesPairsThatAreFarApartAndFixedOnes) {
  auto points = rows_that_end({5, 5, 4, 4, 4}, 1.2);
  EXPECT_EQ(last_pairs_of(straighten_row_ends({}, with_steps(points))), (Ends{5, 5, 4, 4, 4}));
  // The first layer is fixed; the pair of the second goes.
  points = rows_that_end({5, 5, 4, 4, 4});
  std::vector<Vec3> fixed, free;
  for (const Vec3& p : points) (p.x == 0 ? fixed : free).push_back(p);
  EXPECT_EQ(last_pairs_of(straighten_row_ends(fixed, with_steps(free))), (Ends{-1, 4, 4, 4, 4}));
}

TEST(RowStraightening, OfNoPointsIsNothing) {
  EXPECT_TRUE(straighten_row_ends({}, {}).empty());
}

}  // namespace
}  // namespace hexpipe
