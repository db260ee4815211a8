#pragma once
// Text for people, on standard error.

#include <string>

namespace hexpipe {

// Never fails: a closed or full standard error must not end a tool that has its data right.
void print_message(const std::string& text);

}  // namespace hexpipe
