#include "common/run/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "common/run/messages.hpp"

namespace hexpipe {

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)), visible_(!quiet && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (visible_ && next_ > 0) print_text("\r\033[K");
}

bool Progress::due() {
  return visible_ && watch_.seconds() >= next_;
}

void Progress::show(const std::string& text) {
  next_ = watch_.seconds() + 0.1;
  print_text(fmt::format("\r\033[K{}: {}", label_, text));
}

}  // namespace hexpipe
