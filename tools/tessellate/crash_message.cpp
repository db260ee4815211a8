#include "tools/tessellate/crash_message.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>

namespace hexpipe::tessellate {
namespace {

constexpr std::array crash_signals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

// A handler may only use what is ready.
std::string crash_text;
std::array<struct sigaction, crash_signals.size()> actions_before;
// A stack that is too deep has no room for the handler.
std::array<char, 64 << 10> handler_stack;

extern "C" void write_crash_text(int) {
  const ssize_t written = ::write(STDERR_FILENO, crash_text.data(), crash_text.size());
  _exit(written < 0 ? 2 : 1);
}

#ifdef __SANITIZE_ADDRESS__
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

}  // namespace

CrashMessage::CrashMessage(std::string_view file) {
  if (is_sanitized) return;
  crash_text = fmt::format("tessellate: {}: OpenCASCADE crashed on it\n", file);
  const stack_t stack{.ss_sp = handler_stack.data(), .ss_flags = 0, .ss_size = handler_stack.size()};
  sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = write_crash_text;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < crash_signals.size(); ++i) sigaction(crash_signals[i], &action, &actions_before[i]);
}

CrashMessage::~CrashMessage() {
  if (is_sanitized) return;
  for (std::size_t i = 0; i < crash_signals.size(); ++i) sigaction(crash_signals[i], &actions_before[i], nullptr);
}

}  // namespace hexpipe::tessellate
