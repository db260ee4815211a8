#include "common/run/deadline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace hexpipe {
namespace {

TEST(Deadline, WithoutALimitNeverPasses) {
  const Deadline deadline;
  EXPECT_FALSE(deadline.passed());
  EXPECT_GT(deadline.remaining(), 1e300);
}

TEST(Deadline, OfZeroSecondsHasPassed) {
  const Deadline deadline(0.0);
  EXPECT_TRUE(deadline.passed());
  EXPECT_LE(deadline.remaining(), 0);
}

TEST(Deadline, PassesAtItsTime) {
  const Deadline deadline(0.05);
  EXPECT_FALSE(deadline.passed());
  usleep(60000);
  EXPECT_TRUE(deadline.passed());
  EXPECT_GE(deadline.elapsed(), 0.05);
}

// Each in a process of its own: signal state is the process's.
TEST(SignalsDeathTest, TheFirstEndsAToolThatDoesNotSearchAndRemovesItsFile) {
  const std::string path = testing::TempDir() + "signal_test";
  std::ofstream(path) << "half";
  EXPECT_EXIT(
      {
        install_signal_handlers();
        remove_on_signal(path.c_str());
        raise(SIGTERM);
        _exit(0);
      },
      testing::KilledBySignal(SIGTERM), "");
  EXPECT_FALSE(std::ifstream(path).good());
}

TEST(SignalsDeathTest, TheFirstStopsASearchTheSecondEndsIt) {
  EXPECT_EXIT(
      {
        install_signal_handlers();
        stop_searches_on_signal();
        const Deadline deadline;
        raise(SIGINT);
        if (!stop_requested() || !deadline.passed()) _exit(1);
        raise(SIGINT);
        _exit(0);
      },
      testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace hexpipe
