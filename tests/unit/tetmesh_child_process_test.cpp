#include "tools/tetmesh/tetgen/child_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <limits>
#include <thread>

#include "common/run/deadline.hpp"
#include "common/run/error.hpp"

namespace hexpipe {
using namespace tetmesh::tetgen;
namespace {

constexpr double no_timeout = std::numeric_limits<double>::infinity();

ChildEnd run_in_child(const std::function<void()>& work, double timeout) {
  return ChildProcess(work, timeout).wait();
}

bool has_children() {
  return waitpid(-1, nullptr, WNOHANG) != -1 || errno != ECHILD;
}

TEST(ChildProcess, LeavesItsResult) {
  SharedResult shared;
  const std::vector<double> numbers(1'000'000, 2.5);
  const ChildEnd end =
      run_in_child([&] { shared.append(numbers.data(), numbers.size() * sizeof(double)); }, no_timeout);
  EXPECT_EQ(end.kind, ChildEnd::Kind::exited);
  EXPECT_EQ(end.code, 0);
  std::vector<double> taken(numbers.size());
  shared.take(taken.data(), taken.size() * sizeof(double));
  EXPECT_EQ(taken, numbers);
  EXPECT_THROW(shared.take(taken.data(), 1), DataError);
  EXPECT_FALSE(has_children());
}

TEST(ChildProcess, AnIntThrownIsItsExitCodeAndNothingIsUnwound) {
  SharedResult shared;
  struct Witness {
    SharedResult& shared;
    ~Witness() { shared.append("unwound", 7); }
  };
  // GoogleTest calls tests within a try block, as tool_main calls tools.
  const ChildEnd end = run_in_child(
      [&] {
        const Witness witness{shared};
        throw 3;
      },
      no_timeout);
  EXPECT_EQ(end.kind, ChildEnd::Kind::exited);
  EXPECT_EQ(end.code, 3);
  char byte;
  EXPECT_THROW(shared.take(&byte, 1), DataError);
}

TEST(ChildProcess, OtherExceptionsAreUncaught) {
  EXPECT_EQ(run_in_child([] { throw std::runtime_error("no"); }, no_timeout).code, uncaught_exception);
}

TEST(ChildProcess, ACrashIsASignal) {
  const ChildEnd end = run_in_child([] { raise(SIGKILL); }, no_timeout);
  EXPECT_EQ(end.kind, ChildEnd::Kind::killed);
  EXPECT_EQ(end.code, SIGKILL);
  EXPECT_FALSE(has_children());
}

TEST(ChildProcess, IsKilledAfterTheTimeout) {
  const Stopwatch watch;
  const ChildEnd end = run_in_child([] { sleep(100); }, 0.1);
  EXPECT_EQ(end.kind, ChildEnd::Kind::timed_out);
  EXPECT_GE(watch.seconds(), 0.1);
  EXPECT_LT(watch.seconds(), 10);
  EXPECT_FALSE(has_children());
}

TEST(ChildProcess, IsKilledWhenItIsNotWaitedFor) {
  const Stopwatch watch;
  {
    const ChildProcess child([] { sleep(100); }, no_timeout);
  }
  EXPECT_LT(watch.seconds(), 10);
  EXPECT_FALSE(has_children());
}

TEST(ChildProcess, IsEndedInTimeWhateverItsParentDoes) {
  ChildProcess quick([] {}, 0.05), slow([] { sleep(100); }, 0.05);
  usleep(500'000);
  EXPECT_EQ(quick.wait().kind, ChildEnd::Kind::exited);
  EXPECT_EQ(slow.wait().kind, ChildEnd::Kind::timed_out);
}

TEST(ChildProcess, WhatItPrintsIsKeptFromOurOutput) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const ChildEnd end = run_in_child(
      [] {
        for (int i = 0; i < 10000; ++i) std::printf("a line on standard output\n");
        std::fflush(stdout);
        std::fprintf(stderr, "the end\n");
      },
      no_timeout);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(end.code, 0);
}

TEST(ChildProcess, RunsWhileOtherThreadsAllocate) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP()
      << "the sanitizer's allocator keeps other threads' locks over fork(); tetmesh ends its own threads before";
#endif
  std::atomic<bool> stop = false;
  std::thread busy([&] {
    while (!stop) std::vector<int>(1000).swap(*std::make_unique<std::vector<int>>());
  });
  for (int i = 0; i < 50; ++i) {
    const ChildEnd end = run_in_child([] { std::vector<std::string> v(1000, std::string(100, 'x')); }, 60);
    EXPECT_EQ(end.kind, ChildEnd::Kind::exited);
  }
  stop = true;
  busy.join();
}

// The pipe's other end closes when the grandchild is gone.
TEST(ChildProcess, DiesWithItsParent) {
  int alive[2];
  ASSERT_EQ(pipe(alive), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    run_in_child(
        [&] {
          if (write(alive[1], "x", 1) == 1) sleep(100);
        },
        no_timeout);
    _exit(0);
  }
  close(alive[1]);
  char byte;
  ASSERT_EQ(read(alive[0], &byte, 1), 1);
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  pollfd event{alive[0], POLLIN, 0};
  EXPECT_EQ(poll(&event, 1, 10'000), 1);
  EXPECT_EQ(read(alive[0], &byte, 1), 0);
  close(alive[0]);
}

}  // namespace
}  // namespace hexpipe
