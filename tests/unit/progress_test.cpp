// The line of progress, as hexpipe sees it.

#include "common/run/progress.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>

#include "common/run/parallel.hpp"
#include "common/run/progress_record.hpp"

namespace hexpipe {
namespace {

class ProgressTest : public ::testing::Test {
 protected:
  ProgressTest() : record_(memfd_create("progress", 0)) {
    setenv(progress_record_variable, std::to_string(record_).c_str(), 1);
  }
  ~ProgressTest() override {
    unsetenv(progress_record_variable);
    close(record_);
  }
  // Waits until the line has the text. False if that takes too long.
  bool shows(const std::string& text) const {
    for (int i = 0; i < 1000; ++i) {
      if (line().find(text) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  }
  std::string line() const { return read_progress_record(record_); }

 private:
  int record_;
};

TEST_F(ProgressTest, ShowsTheInnermostStepAndItsShareOfTheWhole) {
  const ProgressLine progress("tool", false);
  Step outer("outer", 0.2, 1);
  outer.expect(4);
  outer.advance(2);
  Step inner("inner", 0.5, 1);
  inner.reach(0.5);
  // 0.2 + 0.8 * (2 + 0.75) / 4 = 0.75
  EXPECT_TRUE(shows("75 %, ")) << line();
  EXPECT_TRUE(line().ends_with(", inner")) << line();
  inner.say("12 hexes");
  EXPECT_TRUE(shows(", 12 hexes")) << line();
}

TEST_F(ProgressTest, TheShareNeverFalls) {
  const ProgressLine progress("tool", false);
  {
    Step first("first");
    first.reach(0.6);
    EXPECT_TRUE(shows("60 %")) << line();
  }
  Step again("again");
  again.reach(0.1);
  EXPECT_TRUE(shows("again")) << line();
  EXPECT_TRUE(line().starts_with("60 %")) << line();
}

TEST_F(ProgressTest, ThereIsNoLineWithoutAStep) {
  const ProgressLine progress("tool", false);
  {
    const Step step("working");
    EXPECT_TRUE(shows("working")) << line();
  }
  for (int i = 0; i < 1000 && !line().empty(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(line(), "");
}

TEST_F(ProgressTest, StepsCountFromAllThreads) {
  const ProgressLine progress("tool", false);
  Step step("counting");
  step.expect(20000);
  parallel_for(10000, 16, [&](std::int64_t) {
    const Step beside("beside");
    step.advance();
  });
  EXPECT_TRUE(shows("50 %")) << line();
  EXPECT_TRUE(line().ends_with(", counting")) << line();
}

TEST_F(ProgressTest, IsQuietIfAsked) {
  const ProgressLine progress("tool", true);
  Step step("working");
  EXPECT_FALSE(step.due());
  EXPECT_EQ(line(), "");
}

TEST(TimeLeft, IsToldInUnitsThatPeopleUse) {
  EXPECT_EQ(time_left(0.5, 10, 10), "~10 s left");
  EXPECT_EQ(time_left(0.5, 10, 14), "~6 s left");
  EXPECT_EQ(time_left(0.1, 60, 60), "~9 min left");
  EXPECT_EQ(time_left(0.1, 3600, 3600), "~9 h left");
}

TEST(TimeLeft, IsNotToldTooEarlyOrWhenTheGuessHasRunOut) {
  EXPECT_EQ(time_left(0.01, 10, 10), "");
  EXPECT_EQ(time_left(0.5, 0.2, 0.2), "");
  EXPECT_EQ(time_left(0.5, 10, 21), "");
}

}  // namespace
}  // namespace hexpipe
