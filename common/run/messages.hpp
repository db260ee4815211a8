#pragma once
// Text for people, on standard error.

#include <string>
#include <string_view>

namespace hexpipe {

// Prints "tool: text" as a line on standard error. Names and files may hold control characters that a terminal would
// obey; they are shown as '?'. It never fails: a closed or full standard error must not end a tool whose data are
// right.
void print_message(std::string_view tool, std::string_view text);

// Prints whole lines as they are. It never fails either.
void print_text(const std::string& text);

// Shows a line that the next one replaces, and clears it. Other text clears it first, so that the two never mix.
void show_line(const std::string& text);
void clear_line();
// As show_line, from another thread: allocates nothing.
void redraw_line(std::string_view text);

// What stands before such a line: it goes to the beginning of the line on a terminal and clears it.
inline constexpr std::string_view line_start = "\r\033[K";

// While this is on, nothing is printed. When several processes do the same work, only one prints.
void silence_messages(bool on);

}  // namespace hexpipe
