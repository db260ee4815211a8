#include "common/mwis/ground/search_log.hpp"

#include <fmt/format.h>

#include <utility>

namespace hexpipe::mwis::ground {

SearchLog::SearchLog(const std::string& path, std::string value_name) : value_name_(std::move(value_name)) {
  if (!path.empty()) file_.emplace(path);
}

void SearchLog::record(double seconds, std::int64_t iteration, std::int64_t value) {
  if (!file_ || seconds < next_) return;
  next_ = seconds + 0.02;
  write(seconds, iteration, value);
}

void SearchLog::finish(double seconds, std::int64_t iteration, std::int64_t value) {
  if (!file_) return;
  write(seconds, iteration, value);
  file_->close();
}

void SearchLog::write(double seconds, std::int64_t iteration, std::int64_t value) {
  file_->write(
      fmt::format("{{\"seconds\":{:.3f},\"iteration\":{},\"{}\":{}}}\n", seconds, iteration, value_name_, value));
}

}  // namespace hexpipe::mwis::ground
