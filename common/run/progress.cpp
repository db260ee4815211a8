#include "common/run/progress.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "common/run/messages.hpp"
#include "common/run/progress_record.hpp"

namespace hexpipe {

// Shows the steps of one thread.
class Ticker {
 public:
  Ticker(std::string label, std::optional<int> record) : label_(std::move(label)), record_(record) {}
  ~Ticker();
  Ticker(const Ticker&) = delete;
  Ticker& operator=(const Ticker&) = delete;

  bool list(Step& step);
  void strike(const Step& step);
  void set_detail(Step& step, std::string detail);

 private:
  void start();
  void tick();
  std::string line();
  void show(const std::string& text);

  const std::string label_;
  const std::optional<int> record_;  // where hexpipe reads the line; none: it goes to the terminal
  std::mutex mutex_;
  std::condition_variable wakes_;
  std::vector<Step*> steps_;  // from the outermost to the innermost
  std::thread::id worker_;    // the thread whose steps these are
  std::thread thread_;
  bool ends_ = false;
  Stopwatch watch_;                     // from the first step
  double furthest_ = 0, known_at_ = 0;  // the greatest share so far, and the seconds that it took
  std::string shown_;                   // empty: nothing
};

namespace {

constexpr double tick_seconds = 0.1;
// Work that is shorter shows no line: it would only flicker.
constexpr double patience_seconds = 0.3;
// A step that takes longer than usual is nearly done.
constexpr double nearly_done = 0.97;

std::unique_ptr<Ticker> ticker;  // none: nobody sees the line

// Signals are for the threads that work.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

Ticker::~Ticker() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_all();
  if (thread_.joinable()) thread_.join();
  if (!shown_.empty()) show("");
}

// Without memory for a thread there is no line.
void Ticker::start() {
  worker_ = std::this_thread::get_id();
  watch_ = Stopwatch();
  try {
    const BlockedSignals blocked;
    thread_ = std::thread([this] { tick(); });
  } catch (const std::system_error&) {
    ends_ = true;
  }
}

bool Ticker::list(Step& step) {
  const std::lock_guard lock(mutex_);
  if (ends_) return false;
  if (!thread_.joinable()) start();
  if (ends_ || worker_ != std::this_thread::get_id()) return false;
  steps_.push_back(&step);
  return true;
}

void Ticker::strike(const Step& step) {
  const std::lock_guard lock(mutex_);
  std::erase(steps_, &step);
}

void Ticker::set_detail(Step& step, std::string detail) {
  const std::lock_guard lock(mutex_);
  step.detail_ = std::move(detail);
}

void Ticker::tick() {
  std::unique_lock lock(mutex_);
  while (!wakes_.wait_for(lock, std::chrono::duration<double>(tick_seconds), [&] { return ends_; })) {
    const std::string text = watch_.seconds() < patience_seconds ? "" : line();
    if (text.empty() && shown_.empty()) continue;
    shown_ = text;
    lock.unlock();
    show(text);
    lock.lock();
  }
}

// Empty where no step is under way.
std::string Ticker::line() {
  if (steps_.empty()) return "";
  const char* what = "";
  std::string_view detail;
  double begin = 0, width = 1;
  for (const Step* const step : steps_) {
    if (step->what_ != nullptr) what = step->what_, detail = {};
    if (!step->detail_.empty()) detail = step->detail_;
    begin += width * step->begin_;
    width *= step->end_ - step->begin_;
    if (step == steps_.back()) break;
    begin += width * step->share();
    width /= static_cast<double>(std::max<std::int64_t>(1, step->total_.load(std::memory_order_relaxed)));
  }
  const double share = begin + width * steps_.back()->share();
  if (share > furthest_) furthest_ = share, known_at_ = watch_.seconds();
  // Narrow terminals cut the end off, so what matters most stands first.
  const std::string done = furthest_ > 0 ? fmt::format("{:.0f} %, ", 100 * std::min(furthest_, 0.99)) : "";
  const std::string left = time_left(furthest_, known_at_, watch_.seconds());
  const std::string seconds = left.empty() ? fmt::format("{:.0f} s", watch_.seconds()) : left;
  return fmt::format("{}{}, {}", done, seconds, detail.empty() ? what : detail);
}

void Ticker::show(const std::string& text) {
  if (record_)
    write_progress_record(*record_, text);
  else if (text.empty())
    clear_terminal_line();
  else
    show_terminal_line(fmt::format("{}: {}", label_, text));
}

std::string time_left(double share, double then, double now) {
  constexpr double least_share = 0.05, least_seconds = 1;
  if (share < least_share || now < least_seconds) return "";
  const double left = then / share - now;
  if (left <= 0) return "";
  constexpr double minute = 60, hour = 3600;
  if (left < 2 * minute) return fmt::format("~{:.0f} s left", std::ceil(left));
  if (left < 2 * hour) return fmt::format("~{:.0f} min left", left / minute);
  return fmt::format("~{:.0f} h left", left / hour);
}

ProgressLine::ProgressLine(std::string label, bool quiet) {
  const std::optional<int> record = progress_record_of_parent();
  if (!quiet && (record || has_terminal_line())) ticker = std::make_unique<Ticker>(std::move(label), record);
}

ProgressLine::~ProgressLine() {
  ticker.reset();
}

Step::Step(const char* what, double begin, double end) : what_(what), begin_(begin), end_(end) {
  if (ticker) is_listed_ = ticker->list(*this);
}

Step::~Step() {
  if (is_listed_) ticker->strike(*this);
}

double Step::share() const {
  double share = share_.load(std::memory_order_relaxed);
  if (const std::int64_t total = total_.load(std::memory_order_relaxed); total > 0)
    share = std::max(share, static_cast<double>(done_.load(std::memory_order_relaxed)) / static_cast<double>(total));
  if (const double usual = usual_seconds_.load(std::memory_order_relaxed); usual > 0)
    share = std::max(share, std::min(watch_.seconds() / usual, nearly_done));
  return std::clamp(share, 0.0, 1.0);
}

bool Step::due() {
  if (!is_listed_ || watch_.seconds() < next_) return false;
  next_ = watch_.seconds() + tick_seconds;
  return true;
}

void Step::say(std::string detail) {
  if (is_listed_) ticker->set_detail(*this, std::move(detail));
}

}  // namespace hexpipe
