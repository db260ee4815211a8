#pragma once
// The line of progress: what a process is doing, how far it is and how long it may still take. It is shown on a
// terminal, or by hexpipe, which runs the process; never with -q. A thread shows it ten times a second, so the work
// only has to say where it is.

#include <atomic>
#include <cstdint>
#include <string>

#include "common/run/deadline.hpp"

namespace hexpipe {

// Steps are shown while one exists. tool_main makes it.
class ProgressLine {
 public:
  // `label` precedes the line.
  ProgressLine(std::string label, bool quiet);
  // Clears the line.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
};

// A step of the work, from construction to destruction. Steps nest. If the outer step counts (see expect()), a step
// inside it is the next item of that count. Only the thread that made the first step shows steps; those of other
// threads, which run beside it, are ignored.
class Step {
 public:
  // `what`: a word or two, "looking for hexes"; nothing: the name of the step around it stays. `begin` and `end`: where
  // in the step around it this is, or in all work, as shares of the time that this usually takes.
  explicit Step(const char* what, double begin = 0, double end = 1);
  ~Step();
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

  // The next three say how far the step is; the greatest share that they give counts. Any thread may call them.
  // How much there is to do, and how much more of it is done:
  void expect(std::int64_t total) { total_.store(total, std::memory_order_relaxed); }
  void advance(std::int64_t more = 1) { done_.fetch_add(more, std::memory_order_relaxed); }
  // The share that is done, from 0 to 1.
  void reach(double share) { share_.store(share, std::memory_order_relaxed); }
  // The seconds that it usually takes.
  void usually_takes(double seconds) { usual_seconds_.store(seconds, std::memory_order_relaxed); }

  // True about ten times a second if the line is shown. Ask before making text for say().
  bool due();
  // Shown in place of the name: "12345 hexes".
  void say(std::string detail);

 private:
  friend class Ticker;
  double share() const;

  const char* const what_;
  const double begin_, end_;
  bool is_listed_ = false;
  std::atomic<std::int64_t> total_{0}, done_{0};
  std::atomic<double> share_{0}, usual_seconds_{0};
  std::string detail_;
  Stopwatch watch_;
  double next_ = 0;
};

// "~12 s left", or nothing where it is too early to tell, or the guess has run out: `share` of the work was done
// when it had taken `then` seconds; by now it has taken `now`.
std::string time_left(double share, double then, double now);

}  // namespace hexpipe
