#include "common/run/deadline.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <limits>

#include "common/run/pipe_failure.hpp"
#include "common/run/removed_files.hpp"

namespace hexpipe {
namespace {

// Signal handlers touch these, so they are lock-free atomics.
std::atomic<bool> stop_flag{false};
std::atomic<bool> first_signal_stops_searches{false};
std::atomic<bool> upstream_may_answer{false};
std::atomic<bool> interrupted{false};
std::atomic<unsigned> patience{0};     // seconds that a waiting call may go on after a signal; 0: no call waits
std::atomic<int> impatient_signal{0};  // the signal that stopped the search and ends its waiting

// At most one call waits at a time.
std::chrono::steady_clock::time_point wait_began;
std::chrono::steady_clock::duration waited{};

constexpr unsigned patience_with_writers = 1, patience_with_readers = 3;  // seconds

void end_by(int signal_number) {
  remove_registered_files();
  mark_pipes_as_failed();
  signal(signal_number, SIG_DFL);
  raise(signal_number);
}

void stop_search(int signal_number) {
  if (signal_number == SIGINT) return;
  impatient_signal = signal_number;
  if (const unsigned seconds = patience.load()) alarm(seconds);
}

void on_signal(int signal_number) {
  if (first_signal_stops_searches.load()) {
    if (!stop_flag.exchange(true)) return stop_search(signal_number);
  } else if (signal_number == SIGINT && upstream_may_answer.load() && !interrupted.exchange(true)) {
    return;
  }
  end_by(signal_number);
}

void on_alarm(int) {
  if (patience.load() != 0) end_by(impatient_signal.load());
}

void handle(int signal_number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  // SA_NODEFER: raise() inside the handler takes effect at once. SA_RESTART: a request to stop does not make reads
  // fail.
  action.sa_flags = SA_RESTART | SA_NODEFER;
  sigemptyset(&action.sa_mask);
  sigaction(signal_number, &action, nullptr);
}

}  // namespace

bool Deadline::passed() const {
  return stop_flag.load(std::memory_order_relaxed) || (limit_ && watch_.seconds() >= *limit_);
}

double Deadline::remaining() const {
  return limit_ ? *limit_ - watch_.seconds() : std::numeric_limits<double>::infinity();
}

void stop_searches_on_signal() {
  first_signal_stops_searches = true;
}

void stop_searches_also_on(int signal_number) {
  handle(signal_number, on_signal);
}

bool stop_requested() {
  return stop_flag.load(std::memory_order_relaxed);
}

void leave_interrupt_upstream(bool on) {
  upstream_may_answer = on;
}

// The alarm is set here or in the handler, whichever runs second.
WaitForOther::WaitForOther(unsigned seconds) {
  wait_began = std::chrono::steady_clock::now();
  patience = seconds;
  if (impatient_signal.load() != 0) alarm(seconds);
}

WaitForOther::~WaitForOther() {
  patience = 0;
  waited += std::chrono::steady_clock::now() - wait_began;
}

double seconds_waited() {
  return std::chrono::duration<double>(waited).count();
}

WaitForInput::WaitForInput() : WaitForOther(patience_with_writers) {}
WaitForReader::WaitForReader() : WaitForOther(patience_with_readers) {}

void install_signal_handlers() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) handle(number, on_signal);
  handle(SIGALRM, on_alarm);
  signal(SIGPIPE, SIG_IGN);
}

}  // namespace hexpipe
