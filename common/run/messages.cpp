#include "common/run/messages.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>

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

constexpr std::string_view erase_line = "\r\033[K";

// A line that wraps could not be written over.
std::size_t columns() {
  constexpr std::size_t usual = 80;
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

// The text's beginning, in at most this many columns. Bytes that go on with a character of UTF-8 take none.
std::string_view beginning(std::string_view text, std::size_t columns) {
  std::size_t used = 0;
  for (std::size_t i = 0; i < text.size(); ++i)
    if ((text[i] & 0xc0) != 0x80 && ++used > columns) return text.substr(0, i);
  return text;
}

void print_text(const std::string& text) {
  if (silent) return;
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

void print_message(std::string_view tool, std::string_view text) {
  print_lines(without_control_characters(fmt::format("{}: {}", tool, text)) + '\n');
}

void print_lines(const std::string& lines) {
  print_text(has_terminal_line() ? std::string(erase_line) + lines : lines);
}

bool has_terminal_line() {
  static const bool has = [] {
    const char* const kind = std::getenv("TERM");
    return isatty(STDERR_FILENO) != 0 && (kind == nullptr || std::string_view(kind) != "dumb");
  }();
  return has;
}

void show_terminal_line(const std::string& text) {
  print_text(fmt::format("{}{}", erase_line, beginning(text, columns() - 1)));
}

void clear_terminal_line() {
  print_text(std::string(erase_line));
}

void silence_messages(bool on) {
  silent = on;
}

}  // namespace hexpipe
