#include "common/run/deadline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <thread>

#include "common/run/removed_files.hpp"

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
  const std::string path = ::testing::TempDir() + "signal_test";
  std::ofstream(path) << "half";
  EXPECT_EXIT(
      {
        install_signal_handlers();
        RemovedFile file;
        file.set(path.c_str());
        raise(SIGTERM);
        _exit(0);
      },
      ::testing::KilledBySignal(SIGTERM), "");
  EXPECT_FALSE(std::ifstream(path).good());
}

TEST(SignalsDeathTest, EveryRegisteredFileIsRemoved) {
  const auto path = [](int i) { return ::testing::TempDir() + "signal_test_" + std::to_string(i); };
  for (int i = 0; i < 6; ++i) std::ofstream(path(i)) << "half";
  EXPECT_EXIT(
      {
        install_signal_handlers();
        RemovedFile first;
        RemovedFile second;
        RemovedFile third;
        first.set(path(0).c_str());
        second.set(path(4).c_str());
        second.set(path(1).c_str());  // in place of the one before
        third.set(path(4).c_str());
        third.set("");
        { RemovedFile().set(path(5).c_str()); }
        RemovedFile fourth;  // in the place of one that is gone
        fourth.set(path(2).c_str());
        RemovedFile fifth;
        fifth.set(path(3).c_str());
        raise(SIGTERM);
        _exit(0);
      },
      ::testing::KilledBySignal(SIGTERM), "");
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(std::ifstream(path(i)).good(), i > 3) << i;
    unlink(path(i).c_str());
  }
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
      ::testing::KilledBySignal(SIGINT), "");
}

// Blocked in read(2) on a pipe where nothing comes, as `signal_number` arrives before the read or in it.
void wait_for_nothing(int signal_number, bool before) {
  install_signal_handlers();
  stop_searches_on_signal();
  int ends[2];
  if (pipe(ends) != 0) _exit(1);
  if (before) raise(signal_number);
  const pthread_t reader = pthread_self();
  std::thread sender([&] {
    usleep(100'000);
    if (!before) pthread_kill(reader, signal_number);
    usleep(1'300'000);  // longer than the wait, not than the test
    [[maybe_unused]] const auto written = write(ends[1], "x", 1);
  });
  char byte;
  const WaitForInput wait;
  [[maybe_unused]] const auto got = read(ends[0], &byte, 1);
  _exit(stop_requested() ? 0 : 1);
}

TEST(SignalsDeathTest, ASearchThatWaitsForInputEndsByOneSignalThatIsNoInterrupt) {
  for (const bool before : {true, false})
    for (const int number : {SIGTERM, SIGHUP})
      EXPECT_EXIT(wait_for_nothing(number, before), ::testing::KilledBySignal(number), "") << number << before;
}

// Blocked in write(2) on a pipe that is full and that nobody reads.
void wait_for_nobody() {
  install_signal_handlers();
  stop_searches_on_signal();
  int ends[2];
  if (pipe(ends) != 0) _exit(1);
  raise(SIGTERM);
  const std::string more_than_it_holds(1 << 20, 'x');
  const WaitForReader wait;
  _exit(write(ends[1], more_than_it_holds.data(), more_than_it_holds.size()) < 0 ? 1 : 0);
}

TEST(SignalsDeathTest, ASearchWhoseAnswerNobodyReadsEndsByOneSignalThatIsNoInterrupt) {
  EXPECT_EXIT(wait_for_nobody(), ::testing::KilledBySignal(SIGTERM), "");
}

TEST(SignalsDeathTest, ASearchThatIsInterruptedWaitsForWhatComesDownThePipe) {
  EXPECT_EXIT(wait_for_nothing(SIGINT, false), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace hexpipe
