#include "common/mwis/search_log.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "common/run/error.hpp"
#include "common/run/links.hpp"

namespace hexpipe {

SearchLog::SearchLog(const std::string& path, std::string value_name)
    : path_(path), value_name_(std::move(value_name)) {
  if (path_.empty()) return;
  errno = 0;
  // What the caller has open already, as /dev/stderr, goes on behind what is there.
  file_.open(path_, open_descriptor(path_) ? std::ios::app : std::ios::out);
  if (!file_) throw DataError::at(path_, "cannot write: {}", std::strerror(errno));
}

void SearchLog::record(double seconds, std::int64_t iteration, std::int64_t value) {
  if (path_.empty() || seconds < next_) return;
  next_ = seconds + 0.02;
  write(seconds, iteration, value);
}

void SearchLog::finish(double seconds, std::int64_t iteration, std::int64_t value) {
  if (path_.empty()) return;
  errno = 0;
  write(seconds, iteration, value);
  file_.close();
  if (!file_) throw DataError::at(path_, "cannot write: {}", std::strerror(errno));
}

void SearchLog::write(double seconds, std::int64_t iteration, std::int64_t value) {
  // Flushed, so that a plot can follow the search.
  file_ << fmt::format("{{\"seconds\":{:.3f},\"iteration\":{},\"{}\":{}}}\n", seconds, iteration, value_name_, value)
        << std::flush;
}

}  // namespace hexpipe
