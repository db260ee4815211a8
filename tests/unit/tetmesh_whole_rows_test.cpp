#include "tools/tetmesh/fields/whole_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/run/random.hpp"

namespace hexpipe {
using namespace tetmesh::fields;
namespace {

// Which coordinate of a node is the first of the plane, and which run backwards.
struct Turn {
  bool swapped = false;
  std::array<bool, 2> flipped{};

  std::size_t axis(std::size_t of_plane) const { return swapped ? 1 - of_plane : of_plane; }
};

// Nodes in columns and rows, of which each knows the plane by coordinates of its own.
class Plane {
 public:
  // `columns` are the distances from one column to the next; rows are 1 apart.
  Plane(std::vector<double> columns, std::size_t rows, std::uint64_t seed = 0)
      : columns_(std::move(columns)), rows_(rows), turns_(size()), held_(size()) {
    if (seed == 0) return;
    Random random(seed, 0);
    for (Turn& turn : turns_) turn = {random.below(2) == 1, {random.below(2) == 1, random.below(2) == 1}};
  }

  std::size_t size() const { return (columns_.size() + 1) * rows_; }
  std::size_t node(std::size_t column, std::size_t row) const { return column * rows_ + row; }
  // Holds a coordinate of the plane.
  void hold(std::size_t column, std::size_t row, std::size_t of_plane, double coordinate = 0) {
    const Turn& turn = turns_[node(column, row)];
    held_[node(column, row)][turn.axis(of_plane)] = turn.flipped[of_plane] ? -coordinate : coordinate;
  }
  void hold_column(std::size_t column, double coordinate = 0) {
    for (std::size_t row = 0; row < rows_; ++row) hold(column, row, 0, coordinate);
  }
  // The first and the last column.
  void hold_ends() {
    hold_column(0);
    hold_column(columns_.size());
  }

  void solve() {
    std::vector<std::int64_t> offsets{0};
    std::vector<PeriodicLink<2>> links;
    for (std::size_t c = 0; c <= columns_.size(); ++c)
      for (std::size_t r = 0; r < rows_; ++r) {
        if (c > 0) links.push_back(link(c, r, c - 1, r, {columns_[c - 1], 0}));
        if (r > 0) links.push_back(link(c, r, c, r - 1, {0, 1}));
        if (r + 1 < rows_) links.push_back(link(c, r, c, r + 1, {0, -1}));
        if (c < columns_.size()) links.push_back(link(c, r, c + 1, r, {-columns_[c], 0}));
        offsets.push_back(static_cast<std::int64_t>(links.size()));
      }
    shifts_ = whole_row_shifts<2>({offsets, links}, held_);
  }

  bool has_moved() const { return !shifts_.empty(); }
  // By how much a coordinate of the plane is moved.
  double shift(std::size_t column, std::size_t row, std::size_t of_plane) const {
    const Turn& turn = turns_[node(column, row)];
    const double own = shifts_[node(column, row)][turn.axis(of_plane)];
    return turn.flipped[of_plane] ? -own : own;
  }
  // The distance from one column to another, in a row.
  double between(std::size_t first, std::size_t last, std::size_t row) const {
    double sum = 0;
    for (std::size_t c = first; c < last; ++c) sum += columns_[c];
    return sum + shift(last, row, 0) - shift(first, row, 0);
  }

 private:
  // The coordinates of the plane of the first node are those of the other and `further`.
  PeriodicLink<2> link(std::size_t column, std::size_t row, std::size_t to_column, std::size_t to_row,
                       std::array<double, 2> further) const {
    const Turn &here = turns_[node(column, row)], &there = turns_[node(to_column, to_row)];
    PeriodicLink<2> result;
    result.neighbour = static_cast<std::int32_t>(node(to_column, to_row));
    result.weight = 1;
    for (std::size_t k = 0; k < 2; ++k) {
      result.axis[here.axis(k)] = static_cast<std::uint8_t>(there.axis(k));
      result.flipped[here.axis(k)] = here.flipped[k] != there.flipped[k];
      result.distance[here.axis(k)] = here.flipped[k] ? -further[k] : further[k];
    }
    return result;
  }

  std::vector<double> columns_;
  std::size_t rows_;
  std::vector<Turn> turns_;
  HeldCoordinates<2> held_;
  std::vector<std::array<double, 2>> shifts_;
};

double miss(double number) {
  return std::abs(number - std::round(number));
}

// Of what is spread by iterations.
constexpr double tolerance = 5e-3;

TEST(WholeRows, StretchEvenlyBetweenTwoSides) {
  for (const std::uint64_t seed : {0, 1, 2, 3}) {
    Plane plane(std::vector<double>(6, 0.9), 7, seed);
    plane.hold_ends();
    plane.solve();
    ASSERT_TRUE(plane.has_moved());
    for (std::size_t row = 0; row < 7; ++row) {
      EXPECT_NEAR(plane.between(0, 6, row), 5, tolerance);
      for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(plane.between(c, c + 1, row), 5.0 / 6, tolerance);
      for (std::size_t c = 0; c <= 6; ++c) EXPECT_NEAR(plane.shift(c, row, 1), 0, 1e-9);
    }
  }
}

TEST(WholeRows, StretchEvenlyOverManyColumnsToo) {
  Plane plane(std::vector<double>(81, 1.005), 5);
  plane.hold_ends();
  plane.solve();
  ASSERT_TRUE(plane.has_moved());
  EXPECT_NEAR(plane.between(0, 81, 2), 81, 1e-9);
  for (std::size_t c = 0; c < 81; ++c) EXPECT_NEAR(plane.between(c, c + 1, 2), 1, 2e-3);
}

// Held nodes in one long line are joined in the worst order.
TEST(WholeRows, TakeNoTimeForALongSet) {
  Plane plane(std::vector<double>(100000, 1), 1);
  for (std::size_t c = 0; c <= 100000; ++c) plane.hold(c, 0, 0);
  plane.solve();
  EXPECT_FALSE(plane.has_moved());
}

// Three axes, which each node of a line of four by four nodes knows in an order of its own.
TEST(WholeRows, FollowAxesThatChangeTheirOrder) {
  constexpr std::size_t length = 7, across = 16;
  static constexpr std::array<std::array<std::uint8_t, 3>, 6> orders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  Random random(3, 0);
  std::vector<std::array<std::uint8_t, 3>> axes;  // of each node: which of its axes is each axis of space
  std::vector<std::array<bool, 3>> flipped;
  for (std::size_t i = 0; i < (length + 1) * across; ++i) {
    axes.push_back(orders[random.below(6)]);
    flipped.push_back({random.below(2) == 1, random.below(2) == 1, random.below(2) == 1});
  }
  std::vector<std::int64_t> offsets{0};
  std::vector<PeriodicLink<3>> links;
  HeldCoordinates<3> held(axes.size());
  const auto place = [&](std::size_t i) { return std::array<std::size_t, 3>{i / across, i % across / 4, i % 4}; };
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (std::size_t j = 0; j < axes.size(); ++j) {
      std::array<double, 3> back;
      double steps = 0;
      for (std::size_t d = 0; d < 3; ++d) {
        back[d] = static_cast<double>(place(i)[d]) - static_cast<double>(place(j)[d]);
        steps += std::abs(back[d]);
      }
      if (steps != 1) continue;
      back[0] *= 0.9;  // 6.3 from end to end
      PeriodicLink<3>& link = links.emplace_back();
      link.neighbour = static_cast<std::int32_t>(j);
      link.weight = 1;
      for (std::size_t d = 0; d < 3; ++d) {
        link.axis[axes[i][d]] = axes[j][d];
        link.flipped[axes[i][d]] = flipped[i][d] != flipped[j][d];
        link.distance[axes[i][d]] = flipped[i][d] ? -back[d] : back[d];
      }
    }
    offsets.push_back(static_cast<std::int64_t>(links.size()));
    if (place(i)[0] == 0 || place(i)[0] == length) held[i][axes[i][0]] = 0;
  }
  const auto shifts = whole_row_shifts<3>({offsets, links}, held);
  ASSERT_EQ(shifts.size(), axes.size());
  const auto shift = [&](std::size_t i, std::size_t d) {
    return flipped[i][d] ? -shifts[i][axes[i][d]] : shifts[i][axes[i][d]];
  };
  for (std::size_t i = 0; i < across; ++i) {
    EXPECT_NEAR(0.9 * length + shift(i + length * across, 0) - shift(i, 0), 6, 1e-9);
    for (std::size_t c = 0; c < length; ++c)
      EXPECT_NEAR(0.9 + shift(i + (c + 1) * across, 0) - shift(i + c * across, 0), 6.0 / length, tolerance);
    EXPECT_NEAR(shift(i + 3 * across, 1), 0, 1e-9);
  }
  // Links moved in both directions stay each other's reverse.
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (std::int64_t l = offsets[i]; l < offsets[i + 1]; ++l) {
      PeriodicLink<3> link = links[l];
      link.move(shifts[i], shifts[link.neighbour]);
      PeriodicLink<3> back = links[l].reversed(static_cast<std::int32_t>(i));
      back.move(shifts[links[l].neighbour], shifts[i]);
      const PeriodicLink<3> there = link.reversed(static_cast<std::int32_t>(i));
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(there.distance[k], back.distance[k], 1e-12);
    }
}

TEST(WholeRows, KeepWhatIsWhole) {
  Plane plane(std::vector<double>(8, 0.75), 7);
  plane.hold_ends();
  plane.solve();
  EXPECT_FALSE(plane.has_moved());
}

TEST(WholeRows, KnowCoordinatesBetweenRows) {
  for (const std::uint64_t seed : {0, 5}) {
    Plane plane(std::vector<double>(6, 0.9), 7, seed);
    plane.hold_column(0, 0.25);
    plane.hold_column(6, -0.1);
    plane.solve();
    ASSERT_TRUE(plane.has_moved());
    // 5.4 before: the nearest number that is whole with what the columns are beside their rows.
    for (std::size_t row = 0; row < 7; ++row) EXPECT_NEAR(plane.between(0, 6, row), 5.65, tolerance);
  }
}

// Both sides are one set along the row that joins them, so that the hole can only move between them.
TEST(WholeRows, MoveAHoleThatIsHalfARowOff) {
  for (const std::uint64_t seed : {0, 7, 8}) {
    std::vector<double> columns(21, 1);
    columns[4] = columns[16] = 0.5;
    Plane plane(columns, 17, seed);
    plane.hold_column(0);
    plane.hold_column(21);
    for (std::size_t row = 0; row < 17; ++row)
      if (row == 0 || row == 16)
        for (std::size_t c = 0; c <= 21; ++c)
          if (c < 4 || c > 17) plane.hold(c, row, 0);
    for (const std::size_t row : {7, 8, 9})
      for (const std::size_t c : {9, 10, 11}) plane.hold(c, row, 0);
    plane.solve();
    ASSERT_TRUE(plane.has_moved());
    for (const std::size_t row : {7, 8, 9}) {
      EXPECT_LT(miss(plane.between(0, 9, row)), tolerance);
      EXPECT_LT(miss(plane.between(11, 21, row)), tolerance);
      EXPECT_NEAR(plane.between(9, 11, row), 2, tolerance);
    }
    for (std::size_t c = 0; c <= 21; ++c)
      for (std::size_t row = 0; row < 17; ++row) EXPECT_LT(std::abs(plane.shift(c, row, 0)), 0.51);
  }
}

TEST(WholeRows, DoNotSqueezeWhatIsNarrow) {
  Plane plane({1, 1, 0.7, 0.7, 1, 1}, 7);
  for (const std::size_t c : {0, 1, 2, 4, 5, 6}) plane.hold_column(c);
  plane.solve();
  // Two sets, 1.4 apart: to 1 it stretches by 0.29, so it is one row. 0.45 cannot become anything.
  ASSERT_TRUE(plane.has_moved());
  EXPECT_NEAR(plane.between(2, 4, 3), 1, tolerance);
  Plane narrow({1, 1, 0.45, 1, 1}, 7);
  for (std::size_t c = 0; c <= 5; ++c) narrow.hold_column(c);
  narrow.solve();
  EXPECT_FALSE(narrow.has_moved());
}

TEST(WholeRows, NeedMoreThanAFewHeldNodes) {
  Plane plane(std::vector<double>(6, 0.9), 7);
  plane.hold_column(0);
  for (const std::size_t row : {2, 3, 4}) plane.hold(6, row, 0);
  plane.solve();
  EXPECT_FALSE(plane.has_moved());
}

TEST(WholeRows, KeepNodesThatNothingHolds) {
  Plane plane(std::vector<double>(6, 0.9), 7);
  plane.solve();
  EXPECT_FALSE(plane.has_moved());
}

// Where gaps make a tree, all of them become whole, or nearly so where that moves sets less, each by half a row at
// most.
TEST(WholeShifts, MakeEveryGapOfATreeWhole) {
  Random random(11, 0);
  for (int round = 0; round < 200; ++round) {
    const auto count = static_cast<std::int32_t>(2 + random.below(9));
    std::vector<std::int32_t> sizes;
    std::vector<SetGap> gaps;
    for (std::int32_t set = 0; set < count; ++set) {
      sizes.push_back(static_cast<std::int32_t>(4 + random.below(100)));
      if (set == 0) continue;
      const double offset = static_cast<double>(random.below(1000)) / 1000;
      gaps.push_back({static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(set))), set,
                      random.below(2) == 1, 3, 3.0 * number_at(offset), 3.0 * 8});
    }
    const std::vector<double> shifts = whole_shifts(sizes, gaps);
    for (const SetGap& gap : gaps) {
      const double change = shifts[static_cast<std::size_t>(gap.second)] -
                            (gap.flipped ? -1 : 1) * shifts[static_cast<std::size_t>(gap.first)];
      EXPECT_LT(miss(coordinate_of(gap.offset) + change), 0.01);
      EXPECT_LE(std::abs(change), 0.51);
    }
  }
}

// Three sets of which each sees the others: what the strongest sights say decides.
TEST(WholeShifts, WeighWhatContradicts) {
  const std::vector<std::int32_t> sizes{10, 10, 10};
  const auto gap = [](std::int32_t first, std::int32_t second, double weight, double offset) {
    return SetGap{first, second, false, weight, weight * number_at(offset), weight * 8};
  };
  const std::vector<double> shifts =
      whole_shifts(sizes, std::vector{gap(0, 1, 5, 0.3), gap(0, 2, 1, 0.1), gap(1, 2, 5, 0.4)});
  EXPECT_LT(miss(0.3 + shifts[1] - shifts[0]), 1e-9);
  EXPECT_LT(miss(0.4 + shifts[2] - shifts[1]), 1e-9);
}

}  // namespace
}  // namespace hexpipe
