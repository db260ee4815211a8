#include "tools/tetmesh/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
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

#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/worker_threads.hpp"

namespace hexpipe {
namespace {

constexpr std::size_t kept_output = 4096;
constexpr int no_thread = 117;  // the exit code of a child that could not start
constexpr pid_t reaped = -1;    // in place of a child

[[noreturn]] void fail(const char* what) {
  throw DataError(fmt::format("cannot {}: {}", what, std::strerror(errno)));
}

// With no handler on the stack std::terminate is called where the exception is thrown, before any destructor runs.
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

[[noreturn]] void be_the_child(const std::function<void()>& work, pid_t parent, int output) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) signal(number, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);  // it died before the line above
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  std::set_terminate(exit_with_exception);
  pthread_t thread;
  // A thread has no callers, and so no try blocks above it; main() and the test frameworks have.
  if (pthread_create(&thread, nullptr, run_work, const_cast<std::function<void()>*>(&work)) != 0) _exit(no_thread);
  pthread_join(thread, nullptr);
  _exit(0);
}

// Keeps the last of what comes until the other end closes. False when the time is over first: what has come by then
// counts, however late it is asked for.
bool listen(int descriptor, const Deadline& deadline, std::string& heard) {
  char buffer[4096];
  for (;;) {
    const double milliseconds = std::clamp(std::ceil(1000 * deadline.remaining()), 0.0, 60'000.0);
    pollfd event{descriptor, POLLIN, 0};
    const int ready = poll(&event, 1, static_cast<int>(milliseconds));
    if (ready < 0 && errno != EINTR) fail("wait for a child process");
    if (ready == 0 && milliseconds <= 0) return false;
    if (ready <= 0) continue;
    const ssize_t count = read(descriptor, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return true;
    heard.append(buffer, static_cast<std::size_t>(count));
    if (heard.size() > 2 * kept_output) heard.erase(0, heard.size() - kept_output);
  }
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

ChildProcess::ChildProcess(const std::function<void()>& work, double timeout) : deadline_(timeout) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail("open a pipe");
  const pid_t parent = getpid();
  end_worker_threads();
  child_ = fork();
  if (child_ == 0) be_the_child(work, parent, ends[1]);
  const int error = errno;
  close(ends[1]);
  output_ = ends[0];
  if (child_ > 0) return;
  close(output_);
  errno = error;
  fail("start a child process");
}

ChildProcess::~ChildProcess() {
  close(output_);
  if (child_ == reaped) return;
  kill(child_, SIGKILL);
  ChildEnd unwanted;
  reap(unwanted);
}

// The status that waitpid() gives.
int ChildProcess::reap(ChildEnd& end) {
  int status = 0;
  rusage usage{};
  while (wait4(child_, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  for (const timeval& time : {usage.ru_utime, usage.ru_stime})
    end.seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  child_ = reaped;
  return status;
}

ChildEnd ChildProcess::wait() {
  ChildEnd end;
  const bool in_time = listen(output_, deadline_, end.said);
  if (!in_time) kill(child_, SIGKILL);
  const int status = reap(end);
  if (!in_time) {
    end.kind = ChildEnd::Kind::timed_out;
  } else if (WIFSIGNALED(status)) {
    end.kind = ChildEnd::Kind::killed;
    end.code = WTERMSIG(status);
  } else {
    end.code = WEXITSTATUS(status);
    if (end.code == no_thread) throw DataError("cannot start a thread in a child process");
  }
  return end;
}

}  // namespace hexpipe
