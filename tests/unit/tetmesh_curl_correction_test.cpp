#include "tools/tetmesh/fields/curl_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

#include "common/run/parallel.hpp"

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
  for (const float c : curl_correction<1>(distances, loops, limits)) EXPECT_EQ(c, 0);
}

TEST(CurlCorrection, SharesOutWhatIsMissing) {
  const Loops loops = strip(5);
  std::vector<float> distances(300);
  for (std::size_t i = 0; i < 5; ++i) distances[i] = 1, distances[100 + i] = 1.3f;
  std::vector<float> corrected = curl_correction<1>(distances, loops, limits);
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

// Three paths of two links, each one step too short, share a link, which gains three quarters of a step.
TEST(CurlCorrection, SparesLinksThatChangeMost) {
  Loops loops;
  for (std::int32_t i = 1; i <= 3; ++i) {
    loops.add_step(0, false);
    loops.add_step(i, false);
    loops.close(2);
  }
  const std::vector<float> distances{0.5f, 0.5f, 0.5f, 0.5f}, lengths(4, 0.5f);
  CurlLimits close{.stiffness = 0.001f, .most_iterations = 100, .tolerance = 1e-6};
  const std::vector<float> even = curl_correction<1>(distances, loops, close, lengths);
  EXPECT_NEAR(even[0], 0.75, 0.01);
  close.soft_strain = 0.1;
  // The least sum of cubes.
  for (close.rounds = 1; close.rounds <= 3; ++close.rounds) {
    const std::vector<float> spared = curl_correction<1>(distances, loops, close, lengths);
    EXPECT_NEAR(spared[0], 0.634, 0.01) << close.rounds;
    for (std::size_t i = 1; i <= 3; ++i) EXPECT_NEAR(spared[0] + spared[i], 1, 0.02);
  }
  close.soft_strain = 2;
  EXPECT_NEAR(curl_correction<1>(distances, loops, close, lengths)[0], even[0], 1e-4) << "none changes by more";
}

TEST(CurlCorrection, KeepsTheScaleWhereThatIsAskedFor) {
  Loops loops;
  loops.add_step(0, false);
  loops.add_step(1, true);
  loops.close();
  const std::vector<float> distances{1, 0.5f}, lengths{1, 1};
  CurlLimits close{.stiffness = 1e-4f, .most_iterations = 100, .tolerance = 1e-6, .rounds = 2, .soft_strain = 10};
  const auto corrected = [&](std::size_t i) {
    return distances[i] + curl_correction<1>(distances, loops, close, lengths)[i];
  };
  EXPECT_NEAR(corrected(0), 0.75, 0.01);
  EXPECT_NEAR(corrected(1), 0.75, 0.01);
  close.keeps_scale = true;
  for (const std::size_t i : {0U, 1U}) EXPECT_NEAR(corrected(i), 1.25 / 1.5, 0.01) << "the same product with what was";
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

// The same iteration over single loops and numbers, one after the other.
std::vector<float> plain_correction(std::span<const float> distances, const Loops& loops, const CurlLimits& by) {
  const auto dot = [](const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * b[i];
    return sum;
  };
  const auto add_sums = [&](std::span<const float> values, bool lacking, std::vector<float>& image) {
    for (std::size_t i = 0; i < loops.size(); ++i) {
      float sum = 0;
      for (const std::int32_t step : loops[i]) sum += step < 0 ? -values[~step] : values[step];
      if (lacking) sum = loops.sum_of(i) - sum;
      for (const std::int32_t step : loops[i]) (step < 0 ? image[~step] : image[step]) += step < 0 ? -sum : sum;
    }
  };
  std::vector<float> correction(distances.size()), rest(distances.size()), image(distances.size());
  add_sums(distances, true, rest);
  std::vector<float> direction = rest;
  double product = dot(rest, rest);
  const double enough = by.tolerance * by.tolerance * product;
  for (int k = 0; k < by.most_iterations && product > enough; ++k) {
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = by.stiffness * direction[i];
    add_sums(direction, false, image);
    const auto step = static_cast<float>(product / dot(direction, image));
    for (std::size_t i = 0; i < image.size(); ++i) correction[i] += step * direction[i], rest[i] -= step * image[i];
    const double next = dot(rest, rest);
    const auto onward = static_cast<float>(next / product);
    for (std::size_t i = 0; i < image.size(); ++i) direction[i] = rest[i] + onward * direction[i];
    product = next;
  }
  return correction;
}

// Loops over `links` links in a row, most of them in bundles of K: three links each, with axes in several orders and
// senses. Every other link has plain triangles, too: each axis meets itself, in one sense. Every seventh link has a
// loop for one axis alone, every thirteenth one along each of its numbers, every eleventh two loops that are no bundle.
template <std::size_t K>
Loops loops_over(std::int32_t links) {
  Loops loops;
  const auto number = [](std::int32_t link, std::size_t axis) {
    return static_cast<std::int32_t>(K) * link + static_cast<std::int32_t>(axis % K);
  };
  for (std::int32_t i = 0; i + 3 < links; ++i) {
    const auto turn = static_cast<std::size_t>(i % 5);
    for (std::size_t k = 0; k < K; ++k) {
      loops.add_step(number(i, k), i % 2 == 1);
      loops.add_step(number(i + 3, K - 1 - (k + turn) % K), (turn + k) % 2 == 1);
      loops.add_step(number(i + 1, k + turn), true);
      loops.close(i % 3 == 0 ? 1 : 0);
    }
    for (std::size_t k = 0; i % 2 == 0 && k < K; ++k) {
      loops.add_step(number(i, k), (i & 2) != 0);
      loops.add_step(number(i + 1, k), (i & 4) != 0);
      loops.add_step(number(i + 3, k), (i & 8) != 0);
      loops.close(0.25);
    }
    if (i % 7 == 0) {
      loops.add_step(number(i, turn), i % 2 == 0);
      loops.close(0.5);
    }
    for (std::size_t k = 0; i % 13 == 0 && k < K; ++k) {
      loops.add_step(number(i, k + turn), (turn + k) % 2 == 1);
      loops.close(-0.25 * static_cast<double>(k + 1));
    }
    if (i % 11 == 0)
      for (std::size_t k = 0; k < 2; ++k) {
        loops.add_step(number(i, 0), false);
        loops.add_step(number(i + static_cast<std::int32_t>(k), 0), k == 0);
        loops.close();
      }
  }
  return loops;
}

// Enough links for several parts: each number has to get its sums in the order of the loops, whatever the threads. The
// plain iteration rounds otherwise.
template <std::size_t K>
void expect_as_plain(std::int32_t links) {
  const Loops loops = loops_over<K>(links);
  std::vector<float> distances(K * static_cast<std::size_t>(links));
  for (std::size_t i = 0; i < distances.size(); ++i) distances[i] = std::sin(static_cast<float>(i));
  constexpr CurlLimits few{.stiffness = 0.05f, .most_iterations = 6, .tolerance = 1e-6};
  const std::vector<float> plain = plain_correction(distances, loops, few), lengths(static_cast<std::size_t>(links), 1);
  CurlLimits stiffening = few;
  stiffening.soft_strain = 0.1;
  stiffening.rounds = 2;
  stiffening.keeps_scale = true;
  std::vector<float> first, stiffened;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    const std::vector<float> once = curl_correction<K>(distances, loops, few);
    if (threads == 1) first = once;
    EXPECT_EQ(once, first) << threads << " threads";
    ASSERT_EQ(once.size(), plain.size());
    for (std::size_t i = 0; i < plain.size(); ++i) ASSERT_NEAR(once[i], plain[i], 2e-6) << i;
    const std::vector<float> again = curl_correction<K>(distances, loops, stiffening, lengths);
    if (threads == 1) stiffened = again;
    EXPECT_NE(again, plain);
    EXPECT_EQ(again, stiffened) << threads << " threads";
  }
}

TEST(CurlCorrection, IsThatOfSingleLoops) {
  for (const std::int32_t links : {99, 100, 101}) {
    expect_as_plain<1>(links);
    expect_as_plain<2>(links);
    expect_as_plain<3>(links);
  }
  expect_as_plain<2>(70001);
  expect_as_plain<3>(70000);
}

}  // namespace
}  // namespace hexpipe
