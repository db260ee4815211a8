#pragma once
// The progress of a search over time, for --log: a file with one JSON object per line.

#include <cstdint>
#include <optional>
#include <string>

#include "common/run/deadline.hpp"
#include "common/run/text_file.hpp"

namespace hexpipe::mwis::ground {

class SearchLog {
 public:
  // With an empty path nothing is written. Throws DataError when the file cannot be written.
  explicit SearchLog(const std::string& path, std::string value_name = "weight");

  // Writes {"seconds":...,"iteration":...,"weight":...}, or another value's name, at most fifty times a second: the
  // first thousands of improvements come faster than anyone can plot.
  void record(double seconds, std::int64_t iteration, std::int64_t value);
  // Always writes the last point. Throws DataError when the disk is full.
  void finish(double seconds, std::int64_t iteration, std::int64_t value);

 private:
  void write(double seconds, std::int64_t iteration, std::int64_t value);

  std::optional<TextFile> file_;
  std::string value_name_;
  double next_ = 0;
};

// For a line of progress: how much heavier the solution has become, its gap to a known
// bound, after how many `steps` of the kind `unit`, and how long the search may go on.
std::string progress_text(std::int64_t weight_before, std::int64_t weight, std::optional<std::int64_t> bound,
                          std::int64_t steps, const char* unit, const Deadline& deadline);

}  // namespace hexpipe::mwis::ground
