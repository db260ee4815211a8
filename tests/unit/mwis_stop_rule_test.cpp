#include "common/mwis/local_search/stop_rule.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "common/mwis/local_search/annealing.hpp"

namespace hexpipe {
using namespace mwis::local_search;
namespace {

TEST(StopRule, EndsWhenTheLastHalfGainedTooLittle) {
  StopRule rule(10, 100, 100);
  rule.record(0, 1000);
  rule.record(99, 1000);
  EXPECT_FALSE(rule.is_done()) << "not judged so early";
  rule.record(100, 1010);
  EXPECT_FALSE(rule.is_done()) << "10 in the last half";
  rule.record(199, 1015);
  EXPECT_FALSE(rule.is_done()) << "what was at 100 is no part of the first half";
  rule.record(200, 1015);
  EXPECT_TRUE(rule.is_done()) << "5 since 100";
  rule.record(210, 1020);
  EXPECT_FALSE(rule.is_done()) << "10 since 105";
}

TEST(StopRule, JudgesASampleByWhatTheWholeWouldGain) {
  StopRule rule(10, 100, 1000);
  rule.record(0, 1000);
  rule.record(51, 1001);
  rule.record(100, 1001);
  EXPECT_FALSE(rule.is_done()) << "1 in the last half of a tenth of the work";
  rule.record(102, 1001);
  EXPECT_TRUE(rule.is_done()) << "nothing since 51";
  rule.record(500, 1006);
  EXPECT_FALSE(rule.is_done()) << "10 of the whole";
  rule.record(550, 1006);
  EXPECT_TRUE(rule.is_done()) << "nine of the whole";
}

TEST(StopRule, ExpectsNoMoreOfTheWholeThanOfWhatIsStillUnseen) {
  StopRule rule(10, 100, 1000);
  rule.record(0, 1000);
  rule.record(90, 1003);
  rule.record(100, 1003, 4);
  EXPECT_FALSE(rule.is_done()) << "12 in four times the work";
  rule.record(100, 1003, 3);
  EXPECT_TRUE(rule.is_done()) << "9 in three times the work";
  rule.record(100, 1003, 20);
  EXPECT_FALSE(rule.is_done()) << "30 in the whole work";
}

TEST(StopRule, ExpectsTheWholeOfASearchThatHasGainedEnough) {
  StopRule rule(10, 50, 1000);
  rule.record(0, 1000);
  rule.record(10, 1020, 3);
  rule.record(60, 1023, 3);
  rule.record(100, 1023, 3);
  EXPECT_FALSE(rule.is_done()) << "9 in three times the work, but 30 in the whole, and it has 23";
}

TEST(StopRule, JudgesEarlierWhereAllOfTheGraphIsSeenForNothing) {
  StopRule rule(10, 100, 200);
  rule.record(0, 1000);
  rule.record(19, 1003);
  rule.record(20, 1003, 4, true);
  EXPECT_FALSE(rule.is_done()) << "12 in four times the work";
  rule.record(40, 1003, 4);
  EXPECT_FALSE(rule.is_done()) << "not judged so early";
  rule.record(40, 1003, 4, true);
  EXPECT_TRUE(rule.is_done()) << "nothing since 20";
  rule.record(60, 1010, 4, true);
  rule.record(99, 1010, 4, true);
  EXPECT_FALSE(rule.is_done()) << "it has gained 10";
}

TEST(StopRule, JudgesEarlierWhereAFewGainsHaveEnded) {
  const auto ends_at = [](std::int64_t gain, double last_gain_at, double most_times = 1000) {
    StopRule rule(10, 100, 200);
    rule.record(0, 1000);
    for (double work = 5; work <= 200; work += 5) {
      rule.record(work, work < last_gain_at ? 1000 : 1000 + gain, most_times, work >= 30);
      if (rule.is_done()) return work;
    }
    return 0.0;
  };
  EXPECT_EQ(ends_at(50, 10), 30);    // all seen
  EXPECT_EQ(ends_at(50, 20), 40);    // nothing in the last half
  EXPECT_EQ(ends_at(200, 20), 100);  // too much gained to be sure
  EXPECT_EQ(ends_at(50, 20, std::numeric_limits<double>::infinity()), 100) << "a small graph gains after pauses";
}

TEST(StopRule, NeverEndsWithoutALeastGain) {
  StopRule rule(0, 1, 1);
  rule.record(0, 1000);
  rule.record(1e12, 1000);
  EXPECT_FALSE(rule.is_done());
}

TEST(Cooling, IsHotterWhereFewAreChosen) {
  const Cooling usual;
  for (const std::int64_t many : {1000, 100000}) {
    EXPECT_DOUBLE_EQ(Cooling::for_chosen(many).hot, usual.hot);
    EXPECT_DOUBLE_EQ(Cooling::for_chosen(many).cold, usual.cold);
  }
  const Cooling few = Cooling::for_chosen(100), fewer = Cooling::for_chosen(60);
  EXPECT_GT(few.cold, usual.cold);
  EXPECT_GT(few.hot, usual.hot);
  EXPECT_GT(fewer.cold, few.cold);
  EXPECT_GT(fewer.hot, fewer.cold);
  EXPECT_LE(Cooling::for_chosen(0).cold, Cooling::for_chosen(1).cold);
}

}  // namespace
}  // namespace hexpipe
