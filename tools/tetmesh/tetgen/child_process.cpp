#include "tools/tetmesh/tetgen/child_process.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>

#include "common/run/error.hpp"
#include "common/run/parallel.hpp"

namespace hexpipe::tetmesh::tetgen {
namespace {

constexpr int no_thread = 117;  // the exit code of a child that could not start
constexpr pid_t reaped = -1;    // in place of a child

[[noreturn]] void fail(const char* what) {
  throw DataError(fmt::format("cannot {}: {}", what, std::strerror(errno)));
}

// Without a handler on the stack, std::terminate is called where the exception is thrown, before any destructor runs.
[[noreturn]] void exit_with_exception() {
  try {
    std::rethrow_exception(std::current_exception());
  } catch (const int code) {
    _exit(code);
  } catch (...) {
    _exit(uncaught_exception);
  }
}

void* run_work(void* work) {
  (*static_cast<const std::function<void()>*>(work))();
  return nullptr;
}

// The kernel ends the child when its time is over, whatever the parent is doing.
void set_alarm(double seconds) {
  if (std::isinf(seconds)) return;
  const double whole = std::floor(std::max(seconds, 0.0));
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(whole);
  timer.it_value.tv_usec = std::max<suseconds_t>(1, static_cast<suseconds_t>(1e6 * (std::max(seconds, 0.0) - whole)));
  setitimer(ITIMER_REAL, &timer, nullptr);
}

[[noreturn]] void be_the_child(const std::function<void()>& work, double timeout, pid_t parent) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGALRM}) signal(number, SIG_DFL);
  set_alarm(timeout);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);  // it died before the prctl above
  const int nothing = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, stream);
  std::set_terminate(exit_with_exception);
  pthread_t thread;
  // A thread has no callers, and so no try blocks above it; main() and the test frameworks have some.
  if (pthread_create(&thread, nullptr, run_work, const_cast<std::function<void()>*>(&work)) != 0) _exit(no_thread);
  pthread_join(thread, nullptr);
  _exit(0);
}

// Returns the status that waitpid() gives.
int wait_for(pid_t child, rusage& usage) {
  int status = 0;
  while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

SharedResult::SharedResult() : descriptor_(memfd_create("result", MFD_CLOEXEC)) {
  if (descriptor_ < 0) fail("share memory with a child process");
}

SharedResult::~SharedResult() {
  close(descriptor_);
}

void SharedResult::append(const void* data, std::size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t count = write(descriptor_, next, bytes);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) _exit(write_failed);
    next += count;
    bytes -= static_cast<std::size_t>(count);
  }
}

void SharedResult::take(void* data, std::size_t bytes) {
  char* next = static_cast<char*>(data);
  while (bytes > 0) {
    const ssize_t count = pread(descriptor_, next, bytes, static_cast<off_t>(taken_));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw DataError("a child process left only a part of its result");
    next += count;
    bytes -= static_cast<std::size_t>(count);
    taken_ += static_cast<std::uint64_t>(count);
  }
}

ChildProcess::ChildProcess(const std::function<void()>& work, double timeout) {
  const pid_t parent = getpid();
  end_worker_threads();
  child_ = fork();
  if (child_ < 0) fail("start a child process");
  if (child_ == 0) be_the_child(work, timeout, parent);
}

ChildProcess::~ChildProcess() {
  if (child_ == reaped) return;
  kill(child_, SIGKILL);
  rusage unwanted{};
  wait_for(child_, unwanted);
}

ChildEnd ChildProcess::wait() {
  rusage usage{};
  const int status = wait_for(child_, usage);
  child_ = reaped;
  ChildEnd end;
  for (const timeval& time : {usage.ru_utime, usage.ru_stime})
    end.seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  if (WIFSIGNALED(status)) {
    end.code = WTERMSIG(status);
    end.kind = end.code == SIGALRM ? ChildEnd::Kind::timed_out : ChildEnd::Kind::killed;
  } else {
    end.code = WEXITSTATUS(status);
    if (end.code == no_thread) throw DataError("cannot start a thread in a child process");
  }
  return end;
}

}  // namespace hexpipe::tetmesh::tetgen
