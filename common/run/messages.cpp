#include "common/run/messages.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cstdio>

namespace hexpipe {
namespace {

std::atomic<bool> silent{false};

// Replaces control characters: those of ASCII, and U+0080 to U+009F in UTF-8 (U+009B has the effect of ESC '[').
std::string without_control_characters(std::string text) {
  constexpr char lead = '\xc2';
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < ' ' || c == 0x7f) text[i] = '?';
    if (text[i] == lead && i + 1 < text.size() && (text[i + 1] & 0xe0) == 0x80) text.replace(i, 2, "?");
  }
  return text;
}

}  // namespace

void print_message(std::string_view tool, std::string_view text) {
  print_text(without_control_characters(fmt::format("{}: {}", tool, text)) + '\n');
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
