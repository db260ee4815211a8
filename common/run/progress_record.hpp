#pragma once
// How hexpipe learns how far its tools are: each tool writes its line of progress, again and again, to the start of a
// file in memory, whose descriptor is in the tool's environment.

#include <optional>
#include <string>

namespace hexpipe {

inline constexpr const char* progress_record_variable = "HEXPIPE_PROGRESS_FD";

// The file of this process, if it has one.
std::optional<int> progress_record_of_parent();

// Text that is too long is cut off. Failures are ignored, because the line is only for people.
void write_progress_record(int file, const std::string& text);
std::string read_progress_record(int file);

}  // namespace hexpipe
