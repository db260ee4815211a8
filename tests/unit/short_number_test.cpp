#include "formats/streams/number_writer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "sample_meshes.hpp"

namespace hexpipe {
using namespace formats;
namespace {

TEST(ShortNumber, KeepsWhatFits) {
  EXPECT_EQ(number_within(0.1, 20), "0.1");
  EXPECT_EQ(number_within(1e-5, 20), "1e-05");
  EXPECT_EQ(number_within(1, 16, true), "1.");
  EXPECT_EQ(number_within(1e-5, 16, true), "1.E-5");
  EXPECT_EQ(number_within(-2.5e+20, 16, true), "-2.5E20");
}

TEST(ShortNumber, RoundsWhatDoesNot) {
  EXPECT_EQ(number_within(-9.52639091424853e-05, 20), "-9.5263909142485e-05");
  EXPECT_EQ(number_within(1.110223024625157e-16, 20), "1.11022302462516e-16");
  EXPECT_EQ(number_within(-0.12345678901234567, 16, true), "-0.1234567890123");
  EXPECT_EQ(number_within(0.0999999999999999999, 8), "0.1");
}

TEST(ShortNumber, IsNearAndShortForRandomNumbers) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const double number = random_coordinate(random);
    for (const bool needs_point : {false, true}) {
      const std::string text = number_within(number, 16, needs_point);
      EXPECT_LE(text.size(), 16u) << text;
      EXPECT_NEAR(std::strtod(text.c_str(), nullptr), number, 1e-9 * std::abs(number)) << text;
      EXPECT_TRUE(!needs_point || text.find('.') != std::string::npos) << text;
    }
  }
}

}  // namespace
}  // namespace hexpipe
