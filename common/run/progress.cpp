#include "common/run/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "common/run/messages.hpp"

namespace hexpipe {
namespace {

constexpr std::chrono::milliseconds redraw_interval{500};

}  // namespace

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)),
      visible_(!quiet && (isatty(STDERR_FILENO) != 0 || std::getenv(progress_variable) != nullptr)) {}

Progress::~Progress() {
  if (!visible_) return;
  if (ticker_.joinable()) {
    ticker_.request_stop();
    ticker_.join();
  }
  clear_line();
}

bool Progress::due() {
  return visible_ && watch_.seconds() >= next_;
}

void Progress::show(const std::string& text) {
  next_ = watch_.seconds() + 0.1;
  end_step();
  show_line(fmt::format("{}: {}", label_, text));
}

void Progress::begin(const std::string& step) {
  if (!visible_) return;
  {
    const std::scoped_lock lock(mutex_);
    step_ = step;
    step_began_ = watch_.seconds();
  }
  show_line(fmt::format("{}: {}", label_, step));
  if (ticker_.joinable()) return;
  try {
    ticker_ = std::jthread([this](const std::stop_token& stop) { tick(stop); });
  } catch (const std::system_error&) {  // no memory for a thread: the seconds stand still
  }
}

void Progress::end_step() {
  const std::scoped_lock lock(mutex_);
  step_.clear();
}

// Allocates nothing: a process that is forked off meanwhile may find the allocator of a sanitizer locked.
void Progress::tick(std::stop_token stop) {
  std::array<char, 256> text;
  std::unique_lock lock(mutex_);
  while (!step_changed_.wait_for(lock, stop, redraw_interval, [&] { return stop.stop_requested(); })) {
    if (step_.empty()) continue;
    const auto seconds = static_cast<std::int64_t>(watch_.seconds() - step_began_);
    const auto end = fmt::format_to_n(text.begin(), text.size(), "{}: {}, {} s", label_, step_, seconds);
    redraw_line({text.data(), std::min(end.size, text.size())});
  }
}

}  // namespace hexpipe
