#include "common/mwis/ground/search_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/mwis/ground/target_weight.hpp"

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

std::string progress_text(std::int64_t weight_before, std::int64_t weight, std::optional<std::int64_t> bound,
                          std::int64_t steps, const char* unit, const Deadline& deadline) {
  const double gain =
      weight_before > 0 ? static_cast<double>(weight - weight_before) / static_cast<double>(weight_before) : 0;
  std::string text = fmt::format("{:.2f} % better than at first", 100 * gain);
  if (bound) text += fmt::format(", gap {:.2f} %", 100 * gap_to(*bound, weight));
  text += fmt::format(", after {} {}", steps, unit);
  if (const double left = deadline.remaining(); std::isfinite(left))
    text += fmt::format(", {:.0f} s left", std::max(0.0, left));
  return text;
}

}  // namespace hexpipe::mwis::ground
