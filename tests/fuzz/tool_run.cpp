#include "tests/fuzz/tool_run.hpp"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>

#include "tests/fuzz/targets.hpp"

// The sanitizers define it, with this name and type; without them it is null.
// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" __attribute__((weak)) void __sanitizer_set_report_fd(void* descriptor);

namespace hexpipe {
namespace {

// Takes what is written to standard error while it lives.
class HeardErrors {
 public:
  HeardErrors() : file_(memfd_create("errors", MFD_CLOEXEC)), before_(dup(STDERR_FILENO)) {
    promise(file_ >= 0 && before_ >= 0 && dup2(file_, STDERR_FILENO) >= 0, "standard error can be put aside");
    report_to(before_);
  }
  ~HeardErrors() {
    dup2(before_, STDERR_FILENO);
    report_to(STDERR_FILENO);
    close(file_);
    close(before_);
  }
  HeardErrors(const HeardErrors&) = delete;
  HeardErrors& operator=(const HeardErrors&) = delete;

  std::string text() const {
    std::string heard(static_cast<std::size_t>(std::max<off_t>(lseek(file_, 0, SEEK_END), 0)), '\0');
    promise(pread(file_, heard.data(), heard.size(), 0) == static_cast<ssize_t>(heard.size()), "messages can be read");
    return heard;
  }

 private:
  static void report_to(int descriptor) {
    if (__sanitizer_set_report_fd != nullptr)
      // NOLINTNEXTLINE(performance-no-int-to-ptr)
      __sanitizer_set_report_fd(reinterpret_cast<void*>(static_cast<std::intptr_t>(descriptor)));
  }

  int file_, before_;
};

class SignalHandlers {
 public:
  SignalHandlers() {
    for (std::size_t i = 0; i < numbers.size(); ++i) sigaction(numbers[i], nullptr, &before_[i]);
  }
  ~SignalHandlers() {
    for (std::size_t i = 0; i < numbers.size(); ++i) sigaction(numbers[i], &before_[i], nullptr);
  }
  SignalHandlers(const SignalHandlers&) = delete;
  SignalHandlers& operator=(const SignalHandlers&) = delete;

 private:
  static constexpr std::array numbers{SIGINT, SIGTERM, SIGHUP, SIGALRM, SIGPIPE};
  std::array<struct sigaction, numbers.size()> before_{};
};

}  // namespace

ToolRun run_tool(int (*tool_main)(int, char**), std::vector<std::string> arguments) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const SignalHandlers handlers;
  const HeardErrors errors;
  const int code = tool_main(static_cast<int>(arguments.size()), argv.data());
  return {code, errors.text()};
}

bool is_message_of(std::string_view tool, std::string_view message, std::string_view input) {
  if (!message.starts_with(std::string(tool) + ": ") || message.find('\n') != message.size() - 1) return false;
  message = message.substr(0, message.find('\''));  // behind it are words of the file
  for (const std::string_view foreign : {"std::", "::_M_", "basic_string::", "map::at", "json.exception"})
    if (message.find(foreign) != std::string_view::npos && input.find(foreign) == std::string_view::npos) return false;
  return true;
}

}  // namespace hexpipe
