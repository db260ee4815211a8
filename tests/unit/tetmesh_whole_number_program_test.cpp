#include "tools/tetmesh/fields/whole_number_program.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/run/random.hpp"

namespace hexpipe {
using namespace tetmesh::fields;
namespace {

using Numbers = std::vector<std::int32_t>;

Numbers solved(const std::vector<WholeEquation>& equations, const std::vector<double>& wanted) {
  WholeNumberProgram program(equations, wanted, std::vector<double>(wanted.size(), 1));
  program.relax();
  return program.round();
}

double cost(const Numbers& numbers, const std::vector<double>& wanted) {
  double sum = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) sum += std::pow(numbers[i] - wanted[i], 2);
  return sum;
}

bool hold(const std::vector<WholeEquation>& equations, const Numbers& numbers) {
  for (const WholeEquation& equation : equations) {
    std::int32_t sum = 0;
    for (const auto& [unknown, factor] : equation) sum += factor * numbers[static_cast<std::size_t>(unknown)];
    if (sum != 0) return false;
  }
  return true;
}

TEST(WholeNumberProgram, RoundsWhatNothingBinds) {
  EXPECT_EQ(solved({}, {1.2, -3.7, 5}), (Numbers{1, -4, 5}));
}

TEST(WholeNumberProgram, SpreadsWhatAnEquationMisses) {
  EXPECT_EQ(solved({{{0, 1}, {1, -1}}}, {6.6, 6.2}), (Numbers{6, 6}));
  EXPECT_EQ(solved({{{0, 1}, {1, 1}, {2, -1}}}, {4, 4, 11}), (Numbers{5, 5, 10}));
}

TEST(WholeNumberProgram, MakesSumsEvenByAnUnknownThatMayBeAnything) {
  const std::vector<double> wanted{5.4, 5, 5};
  const Numbers found = solved({{{0, 1}, {1, 1}, {2, 1}, {3, -2}}}, wanted);
  EXPECT_EQ(found, (Numbers{6, 5, 5}));
}

TEST(WholeNumberProgram, LeavesOutWhatHasNoUnknownOnce) {
  EXPECT_EQ(solved({{{0, 2}, {1, -3}}}, {4, 4}), (Numbers{4, 4}));
  EXPECT_EQ(solved({{{0, 2}, {1, -4}}}, {4.2, 2}), (Numbers{4, 2}));
}

TEST(WholeNumberProgram, DropsTheEquationThatIsMissedByMost) {
  const std::vector<WholeEquation> equations{{{0, 1}, {1, -1}}, {{0, 1}, {2, -1}}};
  WholeNumberProgram program(equations, {4, 5, 9}, {1, 1, 1});
  program.relax();
  EXPECT_EQ(program.round(), (Numbers{6, 6, 6}));
  EXPECT_TRUE(program.drop_worst_of(0));
  EXPECT_NEAR(program.relax()->at(0), 4.5, 1e-6);
  EXPECT_EQ(program.round()[2], 9);
  EXPECT_FALSE(program.drop_worst_of(2));
}

// Against all choices near the wanted numbers. Rounding does not always find the best one, but mostly.
TEST(WholeNumberProgram, IsMostlyAsGoodAsBruteForce) {
  Random random(1);
  int best = 0;
  constexpr int trials = 50;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> wanted;
    for (int i = 0; i < 5; ++i) wanted.push_back(random.uniform(3, 9));
    const std::vector<WholeEquation> equations{{{0, 1}, {1, 1}, {2, -1}}, {{2, 1}, {3, -1}, {4, -1}}};
    const Numbers found = solved(equations, wanted);
    ASSERT_TRUE(hold(equations, found));
    double least = HUGE_VAL;
    for (std::int32_t a = 0; a < 12; ++a)
      for (std::int32_t b = 0; b < 12; ++b)
        for (std::int32_t c = 0; c < 12; ++c) least = std::min(least, cost({a, b, a + b, c, a + b - c}, wanted));
    if (cost(found, wanted) < least + 1e-9) ++best;
    EXPECT_LT(cost(found, wanted), least + 2);
  }
  EXPECT_GE(best, trials * 4 / 5);
}

}  // namespace
}  // namespace hexpipe
