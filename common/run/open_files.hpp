#pragma once
// Where a path leads: through symbolic links to another file, or to a file that the process has already open. And how
// many files it may have open.

#include <optional>
#include <string>

namespace hexpipe {

// The file at the end of a chain of symbolic links. A path such as /dev/fd/3 is returned unchanged.
std::string behind_links(std::string path);

// The descriptor that the path names, if it is /dev/stdout, /dev/fd/3 or a link to one of them. Opening such a path
// anew would start at the beginning of a file that the caller wants to continue.
std::optional<int> open_descriptor(const std::string& path);

// Raises the limit on open files as far as the system allows: a mesh may have more parts than the files that a process
// may open without asking for more.
void allow_many_open_files();

}  // namespace hexpipe
