#pragma once
// Files in a zip archive, in which several formats keep theirs.

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hexpipe::formats {

// The names and the bytes of those files that are wanted by their name, in the order of the archive. Archives may
// swell: one with more than 250 times its bytes, and 256 MiB, or with more than 2 GiB in these files is refused. Throws
// DataError for that, and for archives that are damaged; `kind` says what was expected ("a 3MF file"), and `name` is
// that of the archive.
std::vector<std::pair<std::string, std::string>> unpack_zip(std::string_view bytes, const std::string& name,
                                                            std::string_view kind,
                                                            const std::function<bool(std::string_view)>& is_wanted);

}  // namespace hexpipe::formats
