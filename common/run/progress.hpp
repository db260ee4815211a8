#pragma once
// A progress line on standard error. It is shown only on a terminal, and not with -q.

#include <string>

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

 private:
  std::string label_;
  bool visible_;
  Stopwatch watch_;
  double next_ = 0;
};

}  // namespace hexpipe
