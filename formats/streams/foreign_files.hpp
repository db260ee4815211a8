#pragma once
// Files that are neither surfaces nor meshes of ours, told by their first bytes, so that a message can say what they
// are.

#include <optional>
#include <string_view>

namespace hexpipe::formats {

struct ForeignFile {
  std::string_view name;    // "a PDF document"
  std::string_view remedy;  // the end of a message: "; unpack it first", or empty
  bool is_cad = false;      // tessellate reads it
};

// Nothing for files of other kinds, which may be ours.
std::optional<ForeignFile> kind_of_foreign_file(std::string_view bytes);

}  // namespace hexpipe::formats
