#pragma once
// A tool's main() in this process, as often as wanted.

#include <string>
#include <string_view>
#include <vector>

namespace hexpipe {

struct ToolRun {
  int code;
  std::string message;  // on standard error
};

// Signals are handled afterwards as before. A sanitizer's report goes past `message`.
ToolRun run_tool(int (*tool_main)(int, char**), std::vector<std::string> arguments);

// One line that begins with the tool's name, and not the text of an exception of a library, which tells users nothing;
// words of the input may be quoted.
bool is_message_of(std::string_view tool, std::string_view message, std::string_view input);

}  // namespace hexpipe
