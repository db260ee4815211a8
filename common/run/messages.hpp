#pragma once
// Text for people, on standard error.

#include <string>
#include <string_view>

namespace hexpipe {

// "tool: text" as a line of its own on standard error. Control characters, which names and files may hold and a
// terminal would obey, are shown as '?'. Never fails: a closed or full standard error must not end a tool that has its
// data right.
void print_message(std::string_view tool, std::string_view text);

// Text as it is, such as progress that is written over. Never fails either.
void print_text(const std::string& text);

// While on, nothing is printed: of several processes that do the same work one speaks.
void silence_messages(bool on);

}  // namespace hexpipe
