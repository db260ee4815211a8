#include "tools/tetmesh/fields/curl_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hexpipe {
using namespace tetmesh::fields;
namespace {

// A strip of squares: number i is the bottom side of square i, 100 + i its top side, 200 + i the side to its left.
Loops strip(std::int32_t squares) {
  Loops loops;
  for (std::int32_t i = 0; i < squares; ++i) {
    loops.add_step(i, false);
    loops.add_step(200 + i + 1, false);
    loops.add_step(100 + i, true);
    loops.add_step(200 + i, true);
    loops.close();
  }
  return loops;
}

double sum_around(std::span<const float> distances, std::span<const std::int32_t> loop) {
  double sum = 0;
  for (const std::int32_t step : loop) sum += step < 0 ? -distances[~step] : distances[step];
  return sum;
}

constexpr CurlLimits limits{.stiffness = 0.05f, .most_iterations = 40, .tolerance = 1e-2};

TEST(CurlCorrection, LeavesDistancesThatAddUp) {
  const Loops loops = strip(5);
  std::vector<float> distances(300);
  for (std::size_t i = 0; i < 5; ++i) distances[i] = distances[100 + i] = 1 + 0.1f * static_cast<float>(i);
  for (const float c : curl_correction(distances, loops, limits)) EXPECT_EQ(c, 0);
}

TEST(CurlCorrection, SharesOutWhatIsMissing) {
  const Loops loops = strip(5);
  std::vector<float> distances(300);
  for (std::size_t i = 0; i < 5; ++i) distances[i] = 1, distances[100 + i] = 1.3f;
  std::vector<float> corrected = curl_correction(distances, loops, limits);
  for (const std::size_t i : {0U, 2U, 4U}) {
    EXPECT_GT(corrected[i], 0.1);
    EXPECT_NEAR(corrected[i], -corrected[100 + i], 1e-5);
  }
  EXPECT_EQ(corrected[5], 0) << "of no loop";
  for (std::size_t i = 0; i < corrected.size(); ++i) corrected[i] += distances[i];
  for (std::size_t i = 0; i < loops.size(); ++i) {
    EXPECT_NEAR(sum_around(distances, loops[i]), -0.3, 1e-5);
    EXPECT_LT(std::abs(sum_around(corrected, loops[i])), 0.02);
  }
}

TEST(CurlCorrection, ForgetsStepsThatLedNowhere) {
  Loops loops = strip(1);
  loops.add_step(7, false);
  loops.drop();
  EXPECT_EQ(loops.size(), 1U);
  loops.add_step(8, true);
  loops.close();
  ASSERT_EQ(loops[1].size(), 1U);
  EXPECT_EQ(loops[1][0], ~8);
}

}  // namespace
}  // namespace hexpipe
