#include "common/run/messages.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>

namespace hexpipe {
namespace {

std::atomic<bool> silent{false};
std::atomic<bool> line_is_shown{false};

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

// One call, so that text of several threads does not mix.
void put(const std::string& text) {
  if (silent) return;
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

void print_message(std::string_view tool, std::string_view text) {
  print_text(without_control_characters(fmt::format("{}: {}", tool, text)) + '\n');
}

void print_text(const std::string& text) {
  put(line_is_shown.exchange(false) ? std::string(line_start) + text : text);
}

void show_line(const std::string& text) {
  line_is_shown = true;
  put(std::string(line_start) + text);
}

void redraw_line(std::string_view text) {
  std::array<char, 512> bytes;
  const std::size_t size = std::min(text.size(), bytes.size() - line_start.size());
  std::copy_n(line_start.begin(), line_start.size(), bytes.begin());
  std::copy_n(text.begin(), size, bytes.begin() + line_start.size());
  if (silent) return;
  line_is_shown = true;
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, bytes.data(), line_start.size() + size);
}

void clear_line() {
  if (line_is_shown.exchange(false)) put(std::string(line_start));
}

void silence_messages(bool on) {
  silent = on;
}

}  // namespace hexpipe
