#include "common/run/command_line.hpp"

#include <gtest/gtest.h>

namespace hexpipe {
namespace {

const std::vector<std::string> known{"size",       "size-field", "surface", "min-quality",
                                     "time-limit", "threads",    "seed",    "log"};

TEST(NearOption, ForgivesLettersChangedLeftOutPutInOrExchanged) {
  EXPECT_EQ(near_option("--min-qualitx", known), "min-quality");
  EXPECT_EQ(near_option("--min-qulity", known), "min-quality");
  EXPECT_EQ(near_option("--tthreads", known), "threads");
  EXPECT_EQ(near_option("--tiem-limit", known), "time-limit");
  EXPECT_EQ(near_option("--lgo", known), "log");
}

TEST(NearOption, ForgivesUnderscoresASingleDashAndAValueBehindIt) {
  EXPECT_EQ(near_option("--min_quality=0.5", known), "min-quality");
  EXPECT_EQ(near_option("-size", known), "size");
}

TEST(NearOption, KnowsTheOnlyOneThatIsBegun) {
  EXPECT_EQ(near_option("--surf", known), "surface");
  EXPECT_EQ(near_option("--min", known), "min-quality");
  EXPECT_EQ(near_option("--t", known), "");
}

TEST(NearOption, SaysNothingWhereNoneIsNear) {
  EXPECT_EQ(near_option("--no-such-option", known), "");
  EXPECT_EQ(near_option("--", known), "");
  EXPECT_EQ(near_option("", known), "");
  EXPECT_EQ(near_option("--" + std::string(1000000, 's'), known), "");
}

TEST(NearOption, TakesTheNearestOfSeveral) {
  EXPECT_EQ(near_option("--size-fild", known), "size-field");
  EXPECT_EQ(near_option("--sise", known), "size");
}

}  // namespace
}  // namespace hexpipe
