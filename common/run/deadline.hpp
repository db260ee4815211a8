#pragma once
// When a search has to end: at its time limit, or when the user asks for it with SIGINT or SIGTERM.

#include <chrono>
#include <optional>

namespace hexpipe {

// Wall-clock seconds since construction.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

class Deadline {
 public:
  // Without a limit, only a signal ends the search.
  explicit Deadline(std::optional<double> seconds = std::nullopt) : limit_(seconds) {}

  // Cheap enough for every iteration of a search: it takes tens of nanoseconds.
  bool passed() const;
  double elapsed() const { return watch_.seconds(); }
  // Infinite without a limit.
  double remaining() const;

 private:
  Stopwatch watch_;
  std::optional<double> limit_;
};

// After this call, the first SIGINT or SIGTERM makes stop_requested() true and lets every Deadline pass; the second
// ends the process as an uncaught signal would. Without this call, the first one ends the process. In both cases the
// files of common/run/removed_files.hpp are removed. SIGHUP has the effect of SIGTERM.
void stop_searches_on_signal();
bool stop_requested();
// Gives another signal the effect of SIGTERM.
void stop_searches_also_on(int signal_number);

// While this is on, a tool that does not search ignores the first SIGINT. Ctrl-C reaches all processes of a pipeline at
// once, and the search upstream that it stops still has to send its best solution down the pipe. The second SIGINT ends
// the process.
void leave_interrupt_upstream(bool on);

// Construct one around a call that waits for another process; at most one exists at a time.
class WaitForOther {
 public:
  WaitForOther(const WaitForOther&) = delete;
  WaitForOther& operator=(const WaitForOther&) = delete;

 protected:
  explicit WaitForOther(unsigned seconds);
  ~WaitForOther();
};

// For waiting for input. A search that was asked to stop reads on, because a search upstream that was asked at the same
// time may still send its answer. If the request was a signal other than SIGINT, the process ends by that signal when
// nothing has come for a second.
class WaitForInput : WaitForOther {
 public:
  WaitForInput();
};

// For waiting for room in a pipe, in the same way. The reader may be busy for some seconds; a reader that is stuck
// costs three seconds at most. A slow reader makes a large write wait many times, so large writes have to be cut into
// several.
class WaitForReader : WaitForOther {
 public:
  WaitForReader();
};

// How long this process has waited so, for input and for room.
double seconds_waited();

// Makes SIGINT, SIGTERM and SIGHUP remove the registered files before they end the process. Ignores SIGPIPE, so that a
// closed pipe is an error of write(2).
void install_signal_handlers();

}  // namespace hexpipe
