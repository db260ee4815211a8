#pragma once
// A progress line on standard error, only where a person can see it: a terminal, and not with -q.

#include <string>

#include "common/run/deadline.hpp"

namespace hexpipe {

class Progress {
 public:
  // `label` stands before the line.
  Progress(std::string label, bool quiet);
  // Clears the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // True when the line is due again (some ten times a second, never when there is no terminal): ask before making text.
  bool due();
  void show(const std::string& text);

 private:
  std::string label_;
  bool visible_;
  Stopwatch watch_;
  double next_ = 0;
};

}  // namespace hexpipe
