#pragma once
// Text for people, on standard error.

#include <string>
#include <string_view>

namespace hexpipe {

// Prints "tool: text" as a line on standard error. Names and files may hold control characters that a terminal would
// obey; they are shown as '?'. It never fails: a closed or full standard error must not end a tool whose data are
// right.
void print_message(std::string_view tool, std::string_view text);

// Prints lines in place of the line of progress that a terminal may show: one of ours, or of another process in the
// pipe. It never fails either.
void print_lines(const std::string& lines);

// True if standard error is a terminal that can erase a line.
bool has_terminal_line();

// Shows a line that the next one, or a message, takes the place of. It is cut off where it would wrap. One write, so
// that lines of several processes do not mix.
void show_terminal_line(const std::string& text);
void clear_terminal_line();

// While this is on, nothing is printed. When several processes do the same work, only one prints.
void silence_messages(bool on);

}  // namespace hexpipe
