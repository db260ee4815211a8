#pragma once
// Text for people, on standard error.

#include <string>
#include <string_view>

namespace hexpipe {

// Prints "tool: text" as a line on standard error. Names and files may hold control characters that a terminal would
// obey; they are shown as '?'. It never fails: a closed or full standard error must not end a tool whose data are
// right.
void print_message(std::string_view tool, std::string_view text);

// Prints the text as it is; for progress lines that are overwritten. It never fails either.
void print_text(const std::string& text);

// While this is on, nothing is printed. When several processes do the same work, only one prints.
void silence_messages(bool on);

}  // namespace hexpipe
