#pragma once
// When a search has to end: at its time limit, or when the user asks for it by SIGINT or SIGTERM.

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
  // Without a limit only a signal ends the search.
  explicit Deadline(std::optional<double> seconds = std::nullopt) : limit_(seconds) {}

  // Cheap enough for every iteration of a search: tens of nanoseconds.
  bool passed() const;
  double elapsed() const { return watch_.seconds(); }
  // Infinite without a limit.
  double remaining() const;

 private:
  Stopwatch watch_;
  std::optional<double> limit_;
};

// After this call the first SIGINT or SIGTERM makes stop_requested() true and every Deadline pass; the second ends the
// process as an uncaught signal would. Without it the first one already does. Either way the files of
// common/run/removed_files.hpp are gone. SIGHUP does as SIGTERM.
void stop_searches_on_signal();
bool stop_requested();
// Another signal that does as SIGTERM.
void stop_searches_also_on(int signal_number);

// While on, a tool that does not search leaves the first SIGINT to the stages upstream, for Ctrl-C reaches all
// processes of a pipeline at once, and the best solution of the search that it stops is still to come down the pipe.
// The second ends the process.
void leave_interrupt_upstream(bool on);

// Stands around a call that waits for another process. One at a time.
class WaitForOther {
 public:
  WaitForOther(const WaitForOther&) = delete;
  WaitForOther& operator=(const WaitForOther&) = delete;

 protected:
  explicit WaitForOther(unsigned seconds);
  ~WaitForOther();
};

// For input. A search that was asked to stop reads on, for what comes may be the answer of a search upstream that was
// asked at the same time. Where it was asked by another signal than SIGINT, it ends as by that signal when nothing has
// come for a second.
class WaitForInput : WaitForOther {
 public:
  WaitForInput();
};

// For room in a pipe, likewise: its reader may be at work for some seconds, but one that is stuck costs no more than
// three. A call that writes much is many waits for a reader that is slow: it is to be cut into several.
class WaitForReader : WaitForOther {
 public:
  WaitForReader();
};

// Makes SIGINT, SIGTERM and SIGHUP remove registered files before they end the process, and SIGPIPE ignored, so that
// a closed pipe is an error of write(2).
void install_signal_handlers();

}  // namespace hexpipe
