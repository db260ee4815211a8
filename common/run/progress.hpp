#pragma once
// A progress line on standard error. It is shown only on a terminal, or where hexpipe asks for it, and not with -q.
// Messages clear it first (messages.hpp).

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "common/run/deadline.hpp"

namespace hexpipe {

class Progress {
 public:
  // `label` precedes the line.
  Progress(std::string label, bool quiet);
  // Clears the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // True when the line should be printed again (about ten times a second; never without a terminal). Ask before making
  // text.
  bool due();
  void show(const std::string& text);

  // Shows what is done from now on, with the seconds that it takes, until something else is shown.
  void begin(const std::string& step);

 private:
  void tick(std::stop_token stop);
  void end_step();

  std::string label_;
  bool visible_;
  Stopwatch watch_;
  double next_ = 0;
  std::mutex mutex_;  // guards the step
  std::condition_variable_any step_changed_;
  std::string step_;  // empty: nothing to redraw
  double step_began_ = 0;
  std::jthread ticker_;  // runs from the first step on; last, because it uses the others
};

// The variable of the environment by which hexpipe asks its tools for the line.
inline constexpr const char* progress_variable = "HEXPIPE_PROGRESS";

}  // namespace hexpipe
