#pragma once
// Text for people, on standard error.

#include <string>

namespace hexpipe {

// Never fails: a closed or full standard error must not end a tool that has its data right.
void print_message(const std::string& text);

// While on, nothing is printed: of several processes that do the same work one speaks.
void silence_messages(bool on);

}  // namespace hexpipe
