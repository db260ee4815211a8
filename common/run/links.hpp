#pragma once
// Where a path leads: to another file by symbolic links, or to what the process has open already.

#include <optional>
#include <string>

namespace hexpipe {

// The file that a chain of symbolic links names; a path such as /dev/fd/3 stays as it is.
std::string behind_links(std::string path);

// The descriptor that the path names, as /dev/stdout, /dev/fd/3 or a link to one of them do. To open such a path anew
// would be to begin at the start of a file that the caller wants to go on with.
std::optional<int> open_descriptor(const std::string& path);

}  // namespace hexpipe
