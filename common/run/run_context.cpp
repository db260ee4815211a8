#include "common/run/run_context.hpp"

#include "common/run/messages.hpp"

namespace hexpipe {

const char* version() {
  return HEXPIPE_VERSION;
}

Deadline RunContext::deadline() const {
  if (common.time_limit) return Deadline(common.time_limit);
  if (common.iterations) return Deadline();
  return Deadline(info.default_time_limit);
}

void RunContext::note(const std::string& text) const {
  if (common.verbose) print_message(info.name, text);
}

void RunContext::warn(const std::string& text) const {
  if (!common.quiet) print_message(info.name, "warning: " + text);
}

}  // namespace hexpipe
