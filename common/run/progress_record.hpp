#pragma once
// How hexpipe learns how far the tools are that it runs: each writes its line of progress over and over to the start of
// a file in memory, whose descriptor it finds in its environment.

#include <optional>
#include <string>

namespace hexpipe {

inline constexpr const char* progress_record_variable = "HEXPIPE_PROGRESS_FD";

// The file of this process, if it has one.
std::optional<int> progress_record_of_parent();

// Text that is too long is cut off. A failure is no matter: the line is for people.
void write_progress_record(int file, const std::string& text);
std::string read_progress_record(int file);

}  // namespace hexpipe
