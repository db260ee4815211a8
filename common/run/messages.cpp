#include "common/run/messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

namespace hexpipe {
namespace {

std::atomic<bool> silent{false};

}  // namespace

void print_message(std::string_view tool, std::string_view text) {
  std::string line = fmt::format("{}: {}", tool, text);
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
  print_text(line + '\n');
}

void print_text(const std::string& text) {
  if (silent) return;
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

void silence_messages(bool on) {
  silent = on;
}

}  // namespace hexpipe
