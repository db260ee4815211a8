#include "common/mwis/search_log.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "common/run/error.hpp"

namespace hexpipe {

SearchLog::SearchLog(const std::string& path) : path_(path) {
  if (path_.empty()) return;
  errno = 0;
  file_.open(path_);
  if (!file_) throw DataError::at(path_, "cannot write: {}", std::strerror(errno));
}

void SearchLog::record(double seconds, std::int64_t iteration, std::int64_t weight) {
  if (path_.empty() || seconds < next_) return;
  next_ = seconds + 0.02;
  write(seconds, iteration, weight);
}

void SearchLog::finish(double seconds, std::int64_t iteration, std::int64_t weight) {
  if (path_.empty()) return;
  errno = 0;
  write(seconds, iteration, weight);
  file_.close();
  if (!file_) throw DataError::at(path_, "cannot write: {}", std::strerror(errno));
}

void SearchLog::write(double seconds, std::int64_t iteration, std::int64_t weight) {
  // Flushed, so that a plot can follow the search.
  file_ << fmt::format("{{\"seconds\":{:.3f},\"iteration\":{},\"weight\":{}}}\n", seconds, iteration, weight)
        << std::flush;
}

}  // namespace hexpipe
